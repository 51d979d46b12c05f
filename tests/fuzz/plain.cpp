// SPDX-License-Identifier: GPL-3.0-or-later
// All targets without libFuzzer: each takes its seeds, and these damaged by a seeded generator.
//   fuzz_plain [SEED [COUNT [TARGET]]]   COUNT damaged inputs each; prints the seed
//   fuzz_plain --write DIR               writes the seeds to DIR/TARGET/, for libFuzzer to begin with
//   fuzz_plain --take TARGET FILE...     takes inputs that were kept
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <random>

#include "tests/fuzz/seeds.h"
#include "tests/fuzz/target.h"
#include "tools/text/files.h"

namespace {

using vernier::fuzz::Target;
using Random = std::mt19937_64;

std::size_t below(Random& random, std::size_t n) { return random() % n; }

const char* const kWords[] = {"<",
                              ">",
                              "/>",
                              "\"",
                              "'",
                              "&",
                              "=",
                              "(",
                              ")",
                              "^",
                              "-",
                              "+",
                              "1e",
                              "1e999",
                              "nan",
                              "-inf",
                              "0x1",
                              ".",
                              ",",
                              ";",
                              "\n",
                              "\t",
                              "[[",
                              "{",
                              "}",
                              "[mm]",
                              "]]>",
                              "<!--",
                              "\xEF\xBB\xBF",
                              "\xFF",
                              "#",
                              "%",
                              "-0",
                              "99999999999999999999",
                              "\x7f\xff\xff\xff"};

std::string damaged(std::string text, const std::string& other, Random& random) {
  for (std::size_t times = 1 + below(random, 5); times > 0 && !text.empty(); --times) {
    const std::size_t at = below(random, text.size());
    switch (below(random, 8)) {
      case 0:
        text[at] = static_cast<char>(random());
        break;
      case 1:
        text[at] = static_cast<char>(text[at] ^ (1 << below(random, 8)));
        break;
      case 2:
        text.erase(at, 1 + below(random, 8));
        break;
      case 3:
        text.insert(at, kWords[below(random, std::size(kWords))]);
        break;
      case 4:
        text.insert(at, text.substr(below(random, text.size()), 1 + below(random, 40)));
        break;
      case 5:
        text.resize(at);
        break;
      case 6:
        text.replace(at, 1 + below(random, 8), other, below(random, other.size()), 1 + below(random, 40));
        break;
      default:
        text[at] = "0123456789.-eXYZ"[below(random, 16)];
    }
  }
  return text;
}

bool takes(const Target& target, const std::string& bytes, const std::string& which) {
  try {
    target.take({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    return true;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s, %s: %s\n----\n%s\n----\n", target.name, which.c_str(), error.what(),
                 bytes.substr(0, 4000).c_str());
  }
  return false;
}

bool attack(const Target& target, std::uint64_t seed, std::size_t count) {
  const std::vector<std::string> seeds = vernier::fuzz::seeds_of(target.name);
  if (seeds.empty()) {
    std::fprintf(stderr, "%s: no seeds\n", target.name);
    return false;
  }
  for (std::size_t i = 0; i < seeds.size(); ++i)
    if (!takes(target, seeds[i], "seed " + std::to_string(i))) return false;
  Random random(seed);
  for (std::size_t i = 0; i < count; ++i) {
    const std::string& text = seeds[below(random, seeds.size())];
    const std::string& other = seeds[below(random, seeds.size())];
    if (!takes(target, damaged(text, other, random), "input " + std::to_string(i))) return false;
  }
  std::printf("%s: %zu seeds, %zu damaged inputs\n", target.name, seeds.size(), count);
  return true;
}

void write_seeds(const std::string& folder) {
  for (const Target& target : vernier::fuzz::targets()) {
    vernier::text::make_folder(folder + "/" + target.name);
    std::size_t number = 0;
    for (const std::string& seed : vernier::fuzz::seeds_of(target.name))
      vernier::text::write_file(folder + "/" + target.name + "/seed_" + std::to_string(number++), seed);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  auto& targets = vernier::fuzz::targets();
  std::sort(targets.begin(), targets.end(),
            [](const Target& a, const Target& b) { return std::string(a.name) < b.name; });
  bool good = true;
  if (words.size() == 2 && words[0] == "--write") {
    write_seeds(words[1]);
  } else if (words.size() > 2 && words[0] == "--take") {
    for (std::size_t i = 2; i < words.size(); ++i)
      for (const Target& target : targets)
        if (words[1] == target.name)
          good = takes(target, vernier::text::read_file(words[i]), words[i]) && good;
  } else {
    const std::uint64_t seed = words.empty() ? 20260101 : std::strtoull(words[0].c_str(), nullptr, 10);
    const std::size_t count = words.size() > 1 ? std::strtoull(words[1].c_str(), nullptr, 10) : 200;
    std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
    for (const Target& target : targets)
      if (words.size() < 3 || words[2] == target.name) good = attack(target, seed, count) && good;
  }
  return good ? 0 : 1;
}
