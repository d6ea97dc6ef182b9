// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Memory that was freed and that the C library keeps.
#pragma once

#include <cstddef>

namespace quadrille
{

/// Gives freed memory back to the system, so that what a stage has let go does not count at the peak of a later one,
/// where it is 256 MB or more. After phase 1 the GNU library holds back 17 bytes a face, as holes between the blocks of
/// the log. Does nothing with other libraries.
void releaseFreedMemory();

/// For programs, as it counts for the whole process: up to 256 MB that were freed are kept for what comes next, arrays
/// of up to 32 MiB included, which the GNU library else has from the system and gives back one by one. A run of 2
/// million triangles takes a sixth less time so, as a fresh page takes 4 us.
void keepFreedMemory();

/// Has the kernel provide fresh memory by several threads (0: all) in place of page by page when it is written first,
/// where it can; what is there stays.
void provideMemory(void* begin, std::size_t bytes, int threads);

} // namespace quadrille
