// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/raw/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#ifdef __linux__
#include <sys/prctl.h>
#endif

namespace throng::importer {
namespace {

// The data memory of this process, which a child inherits and which counts against its limit.
uint64_t own_data_bytes() {
  unsigned long long pages[6] = {};
  std::FILE* file = std::fopen("/proc/self/statm", "r");
  if (file == nullptr) return 0;
  const int got = std::fscanf(file, "%llu %llu %llu %llu %llu %llu", &pages[0], &pages[1],
                              &pages[2], &pages[3], &pages[4], &pages[5]);
  std::fclose(file);
  return got == 6 ? pages[5] * static_cast<uint64_t>(sysconf(_SC_PAGESIZE)) : 0;
}

void prepare_child(const ChildLimits& limits, uint64_t own_bytes) {
#ifdef __linux__
  prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
  // The caller's handlers would run in the child as well; a crash must simply end it.
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGPIPE, SIGTERM, SIGXCPU}) {
    std::signal(signal, SIG_DFL);
  }
  std::signal(SIGINT, SIG_IGN);  // Ctrl-C reaches the parent, which then ends the child.
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  const rlimit time{limits.seconds, limits.seconds + 1};
  setrlimit(RLIMIT_CPU, &time);
  if (own_bytes > 0) {
    const rlimit memory{own_bytes + limits.bytes, own_bytes + limits.bytes};
    setrlimit(RLIMIT_DATA, &memory);
  }
  const int nowhere = open("/dev/null", O_RDWR);
  if (nowhere >= 0) {  // Neither the library nor what it calls may print.
    dup2(nowhere, 1);
    dup2(nowhere, 2);
  }
}

std::string how_it_ended(int status) {
  if (!WIFSIGNALED(status)) return "the reader of this format ended without a result";
  if (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL) {
    return "the reader of this format took too long or too much memory";
  }
  return fmt::format("the reader of this format crashed on it (signal {})", WTERMSIG(status));
}

}  // namespace

void PipeWriter::write(const void* data, size_t size) const {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t done = ::write(file_, at, std::min<size_t>(size, 1 << 20));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) _exit(1);
    at += done;
    size -= static_cast<size_t>(done);
  }
}

bool PipeReader::read(void* data, size_t size) {
  char* at = static_cast<char*>(data);
  while (size > 0) {
    if (context_.cancel) return false;
    pollfd waiting{file_, POLLIN, 0};
    const int ready = poll(&waiting, 1, 100);  // [ms] How soon a cancel is noticed.
    if (ready == 0 || (ready < 0 && errno == EINTR)) continue;
    const ssize_t got = ready < 0 ? -1 : ::read(file_, at, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += got;
    size -= static_cast<size_t>(got);
  }
  return true;
}

void allow_this_child(uint64_t seconds) {
  rusage used{};
  rlimit limit{};
  if (getrusage(RUSAGE_SELF, &used) != 0 || getrlimit(RLIMIT_CPU, &limit) != 0) return;
  const auto so_far = static_cast<uint64_t>(used.ru_utime.tv_sec + used.ru_stime.tv_sec);
  limit.rlim_cur = std::min<rlim_t>(so_far + 1 + seconds, limit.rlim_max);
  setrlimit(RLIMIT_CPU, &limit);
}

Result<void> run_in_child(const ChildLimits& limits, Context& context,
                          const std::function<void(const PipeWriter&)>& child,
                          const std::function<bool(PipeReader&)>& parent) {
  int ends[2];
  if (pipe(ends) != 0)
    return Error{Errc::kIo, std::string("cannot make a pipe: ") + strerror(errno)};
  fcntl(ends[0], F_SETFD, FD_CLOEXEC);
  fcntl(ends[1], F_SETFD, FD_CLOEXEC);
#ifdef F_SETPIPE_SZ
  fcntl(ends[1], F_SETPIPE_SZ, 1 << 20);
#endif
  const uint64_t own_bytes = own_data_bytes();
  const pid_t id = fork();
  if (id < 0) {
    close(ends[0]);
    close(ends[1]);
    return Error{Errc::kIo, std::string("cannot start a process to read in: ") + strerror(errno)};
  }
  if (id == 0) {
    close(ends[0]);
    prepare_child(limits, own_bytes);
    try {
      child(PipeWriter(ends[1]));
    } catch (...) {  // bad_alloc: it must not continue as a second parent.
      _exit(1);
    }
    _exit(0);  // No destructors, no exit handlers: they are the parent's.
  }
  close(ends[1]);
  bool complete = false;
  PipeReader reader(ends[0], context);
  try {
    complete = parent(reader);
  } catch (...) {  // bad_alloc: the child must not stay behind.
    close(ends[0]);
    kill(id, SIGKILL);
    while (waitpid(id, nullptr, 0) < 0 && errno == EINTR) continue;
    throw;
  }
  close(ends[0]);
  if (complete || context.cancel) kill(id, SIGKILL);
  int status = 0;
  while (waitpid(id, &status, 0) < 0 && errno == EINTR) continue;
  if (context.cancel) return Error{Errc::kCancelled, "cancelled while reading"};
  if (!complete) return Error{Errc::kBadFile, how_it_ended(status)};
  return {};
}

}  // namespace throng::importer
