// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Memory.h"

#include "Base/LargeArray.h"
#include "Base/Parallel.h"

#include <cstdint>

#include <cstdlib> // defines __GLIBC__ where there is one

#if defined(__GLIBC__)
#include <malloc.h>
#endif
#if defined(__linux__)
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace quadrille
{

namespace
{

/// Below this, freed memory is worth more to what comes next than to others: fresh pages take longer than much of what
/// is done with them.
constexpr std::size_t kWorthReleasing = std::size_t{ 1 } << 28;
/// The largest threshold that the GNU library takes.
[[maybe_unused]] constexpr int kLargestThreshold = 1 << 25;

#if defined(__GLIBC__)
bool isWorthReleasing()
{
#if __GLIBC_PREREQ(2, 33)
  return mallinfo2().fordblks >= kWorthReleasing;
#else
  return true;
#endif
}
#endif

} // namespace

void releaseFreedMemory()
{
#if defined(__GLIBC__)
  if (isWorthReleasing())
  {
    malloc_trim(0);
  }
#endif
}

void keepFreedMemory()
{
#if defined(__GLIBC__)
  mallopt(M_MMAP_THRESHOLD, kLargestThreshold);
  mallopt(M_TRIM_THRESHOLD, static_cast<int>(kWorthReleasing));
#endif
}

void provideMemory(void* begin, std::size_t bytes, int threads)
{
#if defined(__linux__)
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  constexpr int kPopulateWrite =
    23; // MADV_POPULATE_WRITE; a kernel before 5.14 refuses it, and pages come later
  const std::uintptr_t first = (reinterpret_cast<std::uintptr_t>(begin) + page - 1) / page * page;
  const std::uintptr_t last = (reinterpret_cast<std::uintptr_t>(begin) + bytes) / page * page;
  if (last <= first || last - first < kLargeArrayStep)
  {
    return;
  }
  parallelFor(last - first, kLargeArrayStep, threads,
    [first](std::size_t from, std::size_t to)
    {
      // NOLINTNEXTLINE(performance-no-int-to-ptr): an address of the same array
      static_cast<void>(madvise(reinterpret_cast<void*>(first + from), to - from, kPopulateWrite));
    });
#else
  static_cast<void>(begin);
  static_cast<void>(bytes);
  static_cast<void>(threads);
#endif
}

} // namespace quadrille
