// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Cad/Isolated.h"

#include "Base/Refuse.h"
#include "Cad/Guarded.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <exception>
#include <mutex>
#include <new>

namespace quadrille
{

namespace
{

constexpr std::uint8_t kResult = 1,
                       kFailure = 2; // the first byte; the last one is it, too, so that none is cut

bool writeAll(int file, const std::uint8_t* bytes, std::size_t count)
{
  while (count > 0)
  {
    const ssize_t written = ::write(file, bytes, count);
    if (written < 0 && errno != EINTR)
    {
      return false;
    }
    bytes += std::max<ssize_t>(0, written);
    count -= static_cast<std::size_t>(std::max<ssize_t>(0, written));
  }
  return true;
}

void send(int file, std::uint8_t kind, const std::vector<std::uint8_t>& bytes)
{
  writeAll(file, &kind, 1) && writeAll(file, bytes.data(), bytes.size()) &&
    writeAll(file, &kind, 1);
}

void sendText(int file, const char* text)
{
  send(file, kFailure, std::vector<std::uint8_t>(text, text + std::strlen(text)));
}

/// Never returns, and runs nothing that the parent has for its own end.
[[noreturn]] void runChild(int file, const std::function<std::vector<std::uint8_t>()>& work)
{
  for (const int signal : { SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGINT, SIGTERM })
  {
    std::signal(signal, SIG_DFL);
  }
  // What Open CASCADE prints by itself is in nobody's interest.
  if (const int nowhere = ::open("/dev/null", O_WRONLY); nowhere >= 0)
  {
    ::dup2(nowhere, STDOUT_FILENO);
    ::dup2(nowhere, STDERR_FILENO);
  }
  try
  {
    send(file, kResult, work());
  }
  catch (const std::bad_alloc&)
  {
    sendText(file, "there is not enough memory for it, or it is damaged");
  }
  catch (const std::exception& error)
  {
    sendText(file, error.what());
  }
  ::_exit(0);
}

/// All that comes until the other end is closed; false where the time is over before.
bool receive(int file, double seconds, std::vector<std::uint8_t>& bytes)
{
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  // As much as a pipe holds. Each page that is touched here is copied first, while the child has it, too.
  std::vector<std::uint8_t> block(std::size_t{ 1 } << 16);
  for (;;)
  {
    const double left =
      std::chrono::duration<double>(end - std::chrono::steady_clock::now()).count();
    if (left <= 0)
    {
      return false;
    }
    pollfd ready{ file, POLLIN, 0 };
    if (::poll(&ready, 1, static_cast<int>(std::min(left * 1000 + 1, 1e6))) <= 0)
    {
      continue; // interrupted, or the time is over
    }
    const ssize_t count = ::read(file, block.data(), block.size());
    if (count == 0)
    {
      return true;
    }
    bytes.insert(bytes.end(), block.begin(), block.begin() + std::max<ssize_t>(0, count));
  }
}

int waitFor(pid_t child)
{
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR)
  {
  }
  return status;
}

} // namespace

std::vector<std::uint8_t> isolated(
  const std::string& what, double seconds, const std::function<std::vector<std::uint8_t>()>& work)
{
  std::array<int, 2> ends{};
  refuseIf(::pipe2(ends.data(), O_CLOEXEC) != 0, what, ": cannot be read: ", std::strerror(errno));
  std::unique_lock<std::mutex> lock(occtMutex());
  const pid_t child = ::fork();
  lock.unlock(); // of both processes
  if (child == 0)
  {
    ::close(ends[0]);
    runChild(ends[1], work);
  }
  ::close(ends[1]);
  std::vector<std::uint8_t> bytes;
  const bool isInTime = child > 0 && receive(ends[0], seconds, bytes);
  ::close(ends[0]);
  refuseIf(child < 0, what, ": cannot be read: no process can be started");
  if (!isInTime)
  {
    ::kill(child, SIGKILL);
  }
  const int status = waitFor(child);
  refuseIf(!isInTime, what, ": reading takes more than ", seconds,
    " seconds: the file is damaged, or the time limit too low");
  refuseIf(WIFSIGNALED(status), what, ": is damaged: Open CASCADE ends on it (",
    strsignal(WTERMSIG(status)), "); export it anew");
  const std::size_t size = bytes.size();
  const std::uint8_t kind = size < 2 ? std::uint8_t{ 0 } : bytes.front();
  refuseIf((kind != kResult && kind != kFailure) || kind != bytes.back(), what,
    ": is damaged: reading it gave no result");
  bytes.pop_back();
  bytes.erase(bytes.begin());
  refuseIf(kind == kFailure, std::string(bytes.begin(), bytes.end()));
  return bytes;
}

} // namespace quadrille
