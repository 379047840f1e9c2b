// SPDX-License-Identifier: Apache-2.0
// Preloaded into the program, this counts each call that changes what is on the disk, and at the one that
// GRIDMERGE_FAULT names ("kill 3", "fail 3 28", "signal 3 15") kills the program, lets the call fail with an
// errno, or sends a signal first. "refuse 0" lets every symbolic link fail with EPERM, as FAT does; with
// "hang 0" no connection is ever ended. The number of calls is written to the file that
// GRIDMERGE_FAULT_COUNT names when the program ends.
#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

struct Plan {
  char action[16] = "";
  int at = 0;
  int what = 0;

  Plan() {
    const char* text = std::getenv("GRIDMERGE_FAULT");
    if (text != nullptr) std::sscanf(text, "%15s %d %d", action, &at, &what);
  }
  bool is(const char* name) const { return std::strcmp(action, name) == 0; }
};

std::atomic<int> calls{0};

const Plan& plan() {
  static const Plan the_plan;
  return the_plan;
}

/// Whether the call has to fail; errno is set then.
bool is_faulty() {
  if (++calls != plan().at) return false;
  if (plan().is("kill")) ::kill(::getpid(), SIGKILL);
  if (plan().is("signal")) ::kill(::getpid(), plan().what);
  if (!plan().is("fail")) return false;
  errno = plan().what;
  return true;
}

template <typename Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

__attribute__((destructor)) void tell_count() {
  const char* path = std::getenv("GRIDMERGE_FAULT_COUNT");
  if (path == nullptr) return;
  if (std::FILE* file = std::fopen(path, "w")) {
    std::fprintf(file, "%d", calls.load());
    std::fclose(file);
  }
}

template <typename... Arguments>
int call(const char* name, Arguments... arguments) {
  return is_faulty() ? -1 : next<int(Arguments...)>(name)(arguments...);
}

mode_t mode_of(int flags, std::va_list list) {
  return (flags & O_CREAT) != 0 ? va_arg(list, mode_t) : 0;
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  std::va_list list;
  va_start(list, flags);
  const mode_t mode = mode_of(flags, list);
  va_end(list);
  if ((flags & O_CREAT) != 0 && is_faulty()) return -1;
  return next<int(const char*, int, mode_t)>("open")(path, flags, mode);
}

ssize_t write(int descriptor, const void* bytes, size_t count) {
  if (descriptor > STDERR_FILENO && is_faulty()) return -1;
  return next<ssize_t(int, const void*, size_t)>("write")(descriptor, bytes, count);
}

int fsync(int descriptor) {
  return call("fsync", descriptor);
}
int rename(const char* from, const char* to) noexcept {
  return call("rename", from, to);
}
int linkat(int from_at, const char* from, int to_at, const char* to, int flags) noexcept {
  return call("linkat", from_at, from, to_at, to, flags);
}
int symlink(const char* text, const char* path) noexcept {
  if (plan().is("refuse")) {
    errno = EPERM;
    return -1;
  }
  return call("symlink", text, path);
}
int mkdir(const char* path, mode_t mode) noexcept {
  return call("mkdir", path, mode);
}
int rmdir(const char* path) noexcept {
  return call("rmdir", path);
}
int unlink(const char* path) noexcept {
  return call("unlink", path);
}
int shutdown(int socket, int how) noexcept {
  while (plan().is("hang")) ::pause();
  return next<int(int, int)>("shutdown")(socket, how);
}
int unlinkat(int at, const char* path, int flags) noexcept {
  return call("unlinkat", at, path, flags);
}
}
