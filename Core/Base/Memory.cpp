// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Memory.h"

#include <cstdlib> // defines __GLIBC__ where there is one

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace quadrille
{

void releaseFreedMemory()
{
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

} // namespace quadrille
