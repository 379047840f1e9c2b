// SPDX-License-Identifier: Apache-2.0
// Linked into the program, this counts each call that changes what is on the disk, each allocation and each
// start of a thread, from the beginning of main() to its end. GRIDMERGE_FAULT names the call that fails:
// "kill 3" kills the program at the third one that changes the disk, "fail 3 28" lets it fail with an errno,
// "signal 3 15" sends a signal first; "memory 3" lets the third allocation fail, "thread 3" the third start.
// "refuse 1" lets every symbolic link fail with errno 1, as FAT does; with "hang 0" no connection is ever
// ended. The numbers of calls are written to the file that GRIDMERGE_FAULT_COUNT names when main() ends. The
// file that GRIDMERGE_FAULT_LOG names gets a line for each folder that is made, and for what is flushed.
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

#include "../support/own_new.hpp"

extern "C" {
int __real_main(int argc, char** argv);  // the program's own, by the linker's --wrap
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* old, size_t size);
void* __libc_memalign(size_t alignment, size_t size);
// A sanitizer's, if there is one.
__attribute__((weak)) void* __interceptor_malloc(size_t size);
__attribute__((weak)) void* __interceptor_calloc(size_t count, size_t size);
__attribute__((weak)) void* __interceptor_realloc(void* old, size_t size);
__attribute__((weak)) void* __interceptor_memalign(size_t alignment, size_t size);
__attribute__((weak)) int __interceptor_pthread_create(pthread_t* thread, const pthread_attr_t* attributes,
                                                       void* (*start)(void*), void* argument);
}

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

// Set within main(): what libraries do before it nobody can answer for.
std::atomic<bool> in_main{false};
std::atomic<int> calls{0};
std::atomic<int> allocations{0};
std::atomic<int> threads{0};

const Plan& plan() {
  static const Plan the_plan;
  return the_plan;
}

/// Whether the call has to fail; errno is set then.
bool is_faulty() {
  if (!in_main || ++calls != plan().at) return false;
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

void tell_counts() {
  const char* path = std::getenv("GRIDMERGE_FAULT_COUNT");
  if (path == nullptr) return;
  if (std::FILE* file = std::fopen(path, "w")) {
    std::fprintf(file, "%d %d %d", calls.load(), allocations.load(), threads.load());
    std::fclose(file);
  }
}

/// A folder that was made, or what was flushed.
void log_call(const char* name, const char* path) {
  const char* log = std::getenv("GRIDMERGE_FAULT_LOG");
  if (log == nullptr) return;
  if (std::FILE* file = std::fopen(log, "a")) {
    std::fprintf(file, "%s %s\n", name, path);
    std::fclose(file);
  }
}

/// Whether there is to be no memory now.
bool is_memory_out() {
  if (!in_main || ++allocations != plan().at || !plan().is("memory")) return false;
  errno = ENOMEM;
  return true;
}

template <typename Own, typename Libc, typename... Arguments>
void* allocate(Own* own, Libc* libc, Arguments... arguments) {
  if (is_memory_out()) return nullptr;
  return own != nullptr ? own(arguments...) : libc(arguments...);
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

// What the loader allocates through these functions looks like a leak, since it is freed by none of them.
const char* __asan_default_options() {
  return "detect_leaks=0";
}

int __wrap_main(int argc, char** argv) {
  plan();
  in_main = true;
  const int code = __real_main(argc, argv);
  in_main = false;
  tell_counts();
  return code;
}

void* malloc(size_t size) noexcept {
  return allocate(__interceptor_malloc, __libc_malloc, size);
}
void* calloc(size_t count, size_t size) noexcept {
  return allocate(__interceptor_calloc, __libc_calloc, count, size);
}
void* realloc(void* old, size_t size) noexcept {
  return allocate(__interceptor_realloc, __libc_realloc, old, size);
}
void* memalign(size_t alignment, size_t size) noexcept {
  return allocate(__interceptor_memalign, __libc_memalign, alignment, size);
}
void* aligned_alloc(size_t alignment, size_t size) noexcept {
  return memalign(alignment, size);
}
int posix_memalign(void** memory, size_t alignment, size_t size) noexcept {
  void* const found = memalign(alignment, size);
  if (found == nullptr) return ENOMEM;
  *memory = found;
  return 0;
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*),
                   void* argument) noexcept {
  if (in_main && ++threads == plan().at && plan().is("thread")) return EAGAIN;
  const auto own = __interceptor_pthread_create;
  return (own != nullptr ? own : next<decltype(pthread_create)>("pthread_create"))(thread, attributes, start,
                                                                                   argument);
}

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
  const int result = call("fsync", descriptor);
  char link[32];
  char path[4096] = "";
  std::snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  if (result == 0 && ::readlink(link, path, sizeof path - 1) > 0) log_call("fsync", path);
  return result;
}
int rename(const char* from, const char* to) noexcept {
  return call("rename", from, to);
}
int linkat(int from_at, const char* from, int to_at, const char* to, int flags) noexcept {
  return call("linkat", from_at, from, to_at, to, flags);
}
int symlink(const char* text, const char* path) noexcept {
  if (plan().is("refuse")) {
    errno = plan().at;
    return -1;
  }
  return call("symlink", text, path);
}
int mkdir(const char* path, mode_t mode) noexcept {
  const int result = call("mkdir", path, mode);
  if (result == 0) log_call("mkdir", path);
  return result;
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

// A sanitizer's operator new would not ask malloc().
void* gridmerge::test::allocate(std::size_t size) noexcept {
  return std::malloc(size);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  if (void* const memory = memalign(static_cast<std::size_t>(alignment), size)) return memory;
  gridmerge::test::fail_to_allocate();
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return operator new(size, alignment);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}
