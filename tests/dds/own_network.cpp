// SPDX-License-Identifier: Apache-2.0
#include "own_network.hpp"

#include <net/if.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>
#include <stdexcept>
#include <thread>

namespace gridmerge::test {

bool in_own_network(const std::function<void()>& body) {
  bool is_apart = false;
  std::thread([&] {
    is_apart = ::unshare(CLONE_NEWNET) == 0;
    if (is_apart) body();
  }).join();
  return is_apart;
}

void set_loopback(bool up) {
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  ifreq request{};
  std::strncpy(request.ifr_name, "lo", IFNAMSIZ - 1);
  request.ifr_flags = static_cast<short>(up ? IFF_UP : 0);
  const bool is_set = ::ioctl(socket, SIOCSIFFLAGS, &request) == 0;
  ::close(socket);
  if (!is_set) throw std::runtime_error("the loopback interface cannot be set");
}

}  // namespace gridmerge::test
