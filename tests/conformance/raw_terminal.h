// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <fcntl.h>
#include <stdlib.h>
#include <termios.h>

#include <string>

namespace vernier {

/// Opens a pseudo terminal that passes bytes unchanged, as a serial line does. Returns this end; other_end:
/// the path of the other one.
inline int raw_terminal(std::string& other_end) {
  const int line = ::posix_openpt(O_RDWR | O_NOCTTY);
  ::grantpt(line), ::unlockpt(line);
  termios raw{};
  ::tcgetattr(line, &raw);
  ::cfmakeraw(&raw);
  ::tcsetattr(line, TCSANOW, &raw);
  char name[64] = {};  // ptsname() has one memory for all threads
  ::ptsname_r(line, name, sizeof name);
  other_end = name;
  return line;
}

}  // namespace vernier
