// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Memory that was freed and that the C library keeps.
#pragma once

#include <cstddef>

namespace quadrille
{

/// Gives freed memory back to the system, so that what a stage has let go does not count at the peak of a later one.
/// After phase 1 the GNU library holds back 17 bytes a face, as holes between the blocks of the log. Does nothing with
/// other libraries.
void releaseFreedMemory();

/// Has the kernel provide fresh memory by several threads (0: all) in place of page by page when it is written first,
/// where it can; what is there stays.
void provideMemory(void* begin, std::size_t bytes, int threads);

} // namespace quadrille
