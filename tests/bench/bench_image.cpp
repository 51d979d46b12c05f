// Compiles one of tests/unit/compile/machines for the benches: bench_image NAME OUT.vimg
#include <cstdio>

#include "tests/unit/compile/poses.h"

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: bench_image MACHINE OUT.vimg\n"), 1;
  const vernier::TestMachine test(argv[1]);
  vernier::write_file(argv[2], {test.compiled.image.begin(), test.compiled.image.end()});
  return 0;
}
