// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Parallel.h"

#include "Base/Progress.h"
#include "Base/TryCount.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace quadrille
{

int resolveThreads(int requested)
{
  if (requested > 0)
  {
    return requested;
  }
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void parallelFor(std::size_t count, std::size_t chunkSize, int threads,
  const std::function<void(std::size_t begin, std::size_t end)>& body)
{
  chunkSize = std::max<std::size_t>(chunkSize, 1);
  const std::size_t chunks = (count + chunkSize - 1) / chunkSize;
  const std::size_t workers = std::min(chunks, static_cast<std::size_t>(resolveThreads(threads)));

  std::atomic<std::size_t> nextChunk{ 0 };
  std::exception_ptr firstError;
  std::mutex errorMutex;
  const auto work = [&]()
  {
    for (std::size_t chunk = nextChunk++; chunk < chunks; chunk = nextChunk++)
    {
      try
      {
        poll(); // a run belongs to the caller's thread; on the others this does nothing
        const std::size_t begin = chunk * chunkSize;
        body(begin, std::min(count, begin + chunkSize));
      }
      catch (...)
      {
        const std::lock_guard<std::mutex> lock(errorMutex);
        if (!firstError)
        {
          firstError = std::current_exception();
        }
        nextChunk = chunks;
      }
    }
  };

  const TryHandover tries;
  std::vector<std::thread> pool;
  for (std::size_t i = 1; i < workers; ++i)
  {
    pool.emplace_back(
      [&]()
      {
        tries.take();
        work();
      });
  }
  work();
  for (std::thread& thread : pool)
  {
    thread.join();
  }
  if (firstError)
  {
    std::rethrow_exception(firstError);
  }
}

} // namespace quadrille
