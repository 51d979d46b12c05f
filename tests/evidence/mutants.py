#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Do the tests of `comp` and `tables`, or of `firmware/core`, find a change of one operator, constant or limit?

Each mutant is one change of one place, drawn with a seed; the changed file is compiled, linked with the tests of
the rooms, and the tests run. A mutant is killed if a test fails, if the sanitizer of undefined behaviour stops it, or
if the tests take ten times as long; one that does not compile is not counted. Prints every survivor with its line, and the share that was killed; exit status 1 below --least.
    mutants.py [--rooms firmware] [--count N] [--seed SEED] [--file PART_OF_A_NAME] [--least PERCENT]
"""
import argparse, os, random, re, shutil, subprocess, sys, tempfile, time
from programs import ROOT, add_options, compile_all, rooms_of, run

CHANGES = [(r"&&", "||"), (r"\|\|", "&&"), (r"==", "!="), (r"!=", "=="), (r"<=", "<"), (r">=", ">"), (r"(?<![<\-=])<(?![<=])", "<="),
           (r"(?<![>\-=])>(?![>=])", ">="), (r"(?<![+\w(,]) \+ ", " - "), (r"(?<=[\w)\]]) \+ (?=[\w(])", " - "), (r"(?<=[\w)\]]) - (?=[\w(])", " + "),
           (r" \* ", " + "), (r">>(?!=)", "<<"), (r"<<(?!=)", ">>"), (r"(?<=[\w)\]]) & (?=[\w(])", " | "), (r"(?<=[\w)\]]) \| (?=[\w(])", " & "),
           (r"\btrue\b", "false"), (r"\bfalse\b", "true"), (r"\b(\d+)\b(?![.'x])", "ONE_MORE"), (r"\+\+", "--"), (r"\+=", "-="), (r"-=", "+=")]
# Text around the place in its line, and the change: why no test can see it.
EQUIVALENT = [
    ("i < e.first_result(); ++i) frame.registers[i]", ("<", "<="), "the first result is computed before anything reads it"),
    ("kBendBits = 24,", ("24", "25"), "a fraction bit more of the factor: it differs by less than its stated error"),
    ("if (left >= 2 && are_limits(", ("2", "3"), "limits at the end are written as two steps with the same result"),
    ("i < e.channel_count; ++i)", ("<", "<="), "the register behind the channels is computed before anything reads it; the source behind the list only the address sanitizer sees"),
    ("kDivisors[] = {12, 240, 6048", ("6048", "6049"), "the sum changes by 1.7e-7, a sixth of its stated error"),
    ("e.constants.size > kMaxRegisters ||", (">", ">="), "the sum of all is refused in the next line"),
    ("e.instructions.size > kMost ||", (">", ">="), "the operand of the first instruction needs a register"),
    ("i < program_.equation.lag_count; ++i) lags_before_[i] = lags_[i]", ("<", "<="), "one state more is copied, which nothing reads; 16 lags are all"),
    ("count_ > begin_ &&", (">", ">="), "a ring without samples is emptied again"),
    ("int bit = kRatioBits + 4;", ("4", "5"), "one bit more, which no ratio below 16 has"),
    ("return numerator < 0 ? -quotient", ("<", "<="), "zero is its own opposite"),
    ("constexpr unsigned kGuardBits = 8;", ("8", "9"), "one guard bit more: the position differs by less than a part of 256 of a count"),
    ("nanometres.shift > 94", (">", ">="), "no setting reaches it"),
    ("s.b >= e.lag_count", (">=", ">"), "a state that is not counted is refused at the end as well"),
    ("(a.high < 0 ? -a.high : 0)", ("<", "<="), "zero is its own opposite"),
    ("a.low > 0 ? a.low", (">", ">="), "both sides are zero then"),
    ("top < 0", ("<", "<="), "a peak of zero has no sign"),
    ("top < 0", ("0", "1"), "a peak of zero has no sign"),
    ("equal(multiple.x, kZero) && equal(", ("&&", "||"), "eight times a point is no point of order two: each of the two follows from the other"),
    ("run_equation(sums.equation, sums.registers, nullptr, false)", ("false", "true"), "an equation without a lag"),
    ("i < 3; ++i) carry(reduced)", ("<", "<="), "a carry more changes nothing"),
    ("if (count_ - begin_ > kSize)", (">", ">="), "the first sample is the same then"),
    ("std::uint64_t before = count_ - 1", ("1", "2"), "neither of the two newest samples has two behind it"),
    ("std::int64_t t[4], gap[3]", ("3", "4"), "a further place that nothing reads"),
    ("std::int64_t t[4], gap[3]", ("4", "5"), "a further place that nothing reads"),
    ("scale.rate_mHz < 1 ||", ("1", "2"), "a corner of at least 1 mHz needs a rate 64 times as high"),
    ("const std::int64_t p[4]", ("4", "5"), "a fifth place that nothing reads"),
    ("i < 3; ++i) carry(reduced)", ("3", "4"), "a carry more changes nothing"),
    ("int i = 0; i < 3; ++i) carry(reduced)", ("0", "1"), "two carries bring each sum or difference of two products below 2^256"),
    ("less.digit[i - 1] &= 0xffff", ("-", "+"), "only a value of [2p, 2p + 19) shows it: one in 2^251"),
    ("less.digit[i - 1] &= 0xffff", ("1", "2"), "only a value of [2p, 2p + 19) shows it: one in 2^251"),
    ("int i = 7; i > 0; --i) v[i]", (">", ">="), "the first word is set in the lines after"),
    ("wanted_ == nullptr || wanted_ == offered_", ("||", "&&"), "the same program is withdrawn and offered again"),
    ("kPerMillion[3]", ("3", "4"), "a further place that nothing reads"),
    ("!exchange_.ticks.read(count - 1, tick) || !exchange_.health", ("||", "&&"), "the newest of each can be read where the other can"),
    ("sizeof(LinkTouchAxis) > out.room()", (">", ">="), "the room is odd and a touch is even"),
    ("i < 3; ++i) head.workpiece_nm[i]", ("<", "<="), "the next field of both records is the same"),
    ("i < 3; ++i) head.workpiece_nm[i]", ("3", "4"), "the next field of both records is the same"),
    ("i < now_->program.input_count; ++i", ("<", "<="), "an input that the program does not have is not read"),
    ("wrap.period <= 0 || wrap.reciprocal", ("||", "&&"), "the bound of the error refuses it"),
    ("wrap.period <= 0 ||", ("<=", "<"), "the bound of the error refuses it"),
    ("wrap.reciprocal <= 0 ||", ("<=", "<"), "the bound of the error refuses it"),
    ("i < tick.lag_count; ++i) lags[i] = state.lag[i]", ("<", "<="), "one state more is copied, which nothing reads; 16 lags are all"),
    ("shift >= 64 ? 0 : x.mantissa", (">=", ">"), "no angle reaches it: the smallest, 1 mHz at 2^30 mHz, needs a shift of 56"),
    ("nanometres.shift > 94", ("94", "95"), "no setting reaches it"),
    ("return value < 0 ? -higher(value", ("<", "<="), "zero is its own opposite"),
    ("if (answered > 0) reply[0]", ("0", "1"), "a reply has a head of three bytes"),
    ("kOrder[32]", ("32", "33"), "a further place that nothing reads"),
    ("registers[0] = 12345;", ("0", "1"), "the time of an operation does not depend on its values"),
    ("term = {0, 0, 20};", ("0", "1"), "the time of a product does not depend on its registers"),
    ("written && at < image_bytes", ("<", "<="), "one write of no bytes"),
    ("std::uint32_t i = 0; i < kMaxAxes; ++i) axis[i] = i", ("0", "1"), "the first is 0 already"),
    ("int pass = 0; pass < 2; ++pass", ("<", "<="), "a pass more finds a value below the prime"),
    ("int pass = 0; pass < 2; ++pass", ("2", "3"), "a pass more finds a value below the prime"),
    ("state.weight[k] <= kFullWeight.count", ("<=", "<"), "the full weight is that of the exchange before the start"),
    ("return narrow(value < 0 ? -quotient", ("<", "<="), "zero is its own opposite"),
    ("if (size > 0) std::memcpy(bytes_ + used_", (">", ">="), "a copy of no bytes"),
    ("12 * (root + bit) * (root + bit) <= twelve_times", ("<=", "<"), "a root that is exact is one too small then, and rounded up in the next line"),
    ("w[i] = 0;", ("0", "1"), "the eight bytes after it shift the one out"),
    ("std::uint64_t{weight} * 10'000 + 32768", ("32768", "32769"), "a multiple of 16 is not one below a half of 65536"),
    ("equation.channel_count = 1;", ("1", "2"), "the last sum is in the padding behind the registers, which nothing reads"),
    ("digest[Sha512::kBytes], scalar[32], expected[32]", ("32", "33"), "a further place that nothing reads"),
    ("std::uint64_t w[16], v[8]", ("16", "17"), "a further place that nothing reads"),
    ("std::uint64_t w[16], v[8]", ("8", "9"), "a further place that nothing reads"),
    ("std::int64_t digit[16]", ("16", "17"), "a further place that nothing reads"),
    ("std::int64_t wide[31]", ("31", "32"), "a further place that nothing reads"),
    ("std::uint8_t one[32], two[32]", ("32", "33"), "a further place that nothing reads"),
    ("std::uint8_t bytes[32];", ("32", "33"), "a further place that nothing reads"),
    ("std::uint8_t reduced[32];", ("32", "33"), "a further place that nothing reads"),
    ("PositionNm machine[3], workpiece[3]", ("3", "4"), "a further place that nothing reads"),
    ("kNames[3]", ("3", "4"), "a further place that nothing reads"),
    ("std::int32_t registers[1 + kSums]", ("1", "2"), "a further place that nothing reads"),
    ("level > limits_.lost_share_q16 ?", (">", ">="), "the difference is zero then"),
    ("bool on = false;", ("false", "true"), "a line that is read writes the value, and one that is not counts as off"),
    ("silent_[input] < UINT32_MAX ?", ("<", "<="), "only 2^32 ticks of silence show it, 49 days after the fault is latched"),
    ("missing_ < UINT32_MAX ?", ("<", "<="), "only 2^32 ticks of silence show it, 49 days after the fault is latched"),
    ("172800, 5322240", ("172800", "172801"), "the sum changes by 5e-10, less than a unit of the result"),
    ("172800, 5322240", ("5322240", "5322241"), "the sum changes by 2e-12, less than a unit of the result"),
    ("(image_bytes + 7) / 8", ("7", "8"), "a word more, which nothing reads"),
    ("kTerms = 64, kSums = 32, kRuns = 40", ("64", "65"), "a term more, which no sum reads"),
    ("kTerms = 64, kSums = 32, kRuns = 40", ("32", "33"), "more work in a measurement, whose time is divided by its work"),
    ("kTerms = 64, kSums = 32, kRuns = 40", ("40", "41"), "more work in a measurement, whose time is divided by its work"),
    ("kTravelGuard = 14", ("14", "15"), "one guard bit more: the widest value stays below 2^63"),
]


def places(path):
    """(line number, column, old, new) of each possible change; comments, includes, templates and assertions are left out."""
    found = []
    left_out = False  # of this build, which has no vectors of 256 bits
    for number, line in enumerate(open(os.path.join(ROOT, path)), 1):
        if re.match(r"#(if|endif)", line):
            left_out = line.startswith("#if VERNIER_THREE_TABLES")
        if left_out:
            continue
        code = re.sub(r'"[^"]*"', lambda m: " " * len(m.group()), line.split("//")[0])
        if re.match(r"\s*(#|template|static_assert|using|namespace|\})", code) or "static_cast<" in code and code.count("<") == 1:
            continue
        blank = lambda m: m.group(1) + " " * (len(m.group()) - len(m.group(1)))
        code = re.sub(r"(static_cast|reinterpret_cast|View|lower|higher|clamp|array|numeric_limits)<[^<>]*>", blank, code)
        for pattern, new in CHANGES:
            for hit in re.finditer(pattern, code):
                replacement = str(int(hit.group(1)) + 1) if new == "ONE_MORE" else new
                found.append((path, number, hit.start(), hit.group(), replacement))
    return found


def is_equivalent(place):
    path, number, column, old, new = place
    line = open(os.path.join(ROOT, path)).read().split("\n")[number - 1]
    covers = lambda text: text in line and line.index(text) <= column < line.index(text) + len(text)
    return any(covers(text) and (old.strip(), new.strip()) == change for text, change, _ in EQUIVALENT)


def mutated(place):
    path, number, column, old, new = place
    lines = open(os.path.join(ROOT, path)).read().split("\n")
    line = lines[number - 1]
    lines[number - 1] = line[:column] + new + line[column + len(old):]
    return "\n".join(lines)


class Bench:
    def __init__(self, build, rooms):
        flags = ["-O1", "-w", *rooms.flags]
        self.build, self.flags, self.libraries = build, flags + rooms.flags_of_rooms, rooms.libraries
        self.rooms = dict(zip(rooms.sources, compile_all("c++", rooms.sources, os.path.join(build, "rooms"), self.flags)))
        self.tests = compile_all("c++", rooms.tests, os.path.join(build, "tests"), flags)
        self.first = ["*"]
        begun = time.monotonic()
        if not self.passes(self.rooms.values(), None):
            sys.exit("the tests fail without a change")
        self.patience = max(10, 10 * (time.monotonic() - begun))
        self.first = self.quick_tests_first()

    def quick_tests_first(self):
        """Filters of two runs: most mutants are killed by a test that takes little time."""
        report = run([os.path.join(self.build, "tests.bin"), "--gtest_print_time=1"])
        times = {name: int(ms) for name, ms in re.findall(r"\[ +OK \] (\S+) \((\d+) ms\)", report)}
        slow = ":".join(name for name, ms in times.items() if 20 * ms > sum(times.values()))
        return ["-" + slow, slow] if slow else ["*"]

    def passes(self, objects, patience):
        program = os.path.join(self.build, "tests.bin")
        run(["c++", *objects, *self.tests, *self.libraries, "-o", program])
        try:
            return all(self.run_tests(program, which, patience) for which in self.first)
        except subprocess.TimeoutExpired:
            return False

    def run_tests(self, program, which, patience):
        command = [program, "--gtest_brief=1", "--gtest_fail_fast", "--gtest_filter=" + which]
        return subprocess.run(command, capture_output=True, timeout=patience).returncode == 0

    def survives(self, place):
        folder = os.path.join(self.build, "mutant")
        shutil.rmtree(folder, ignore_errors=True)
        source = os.path.join(folder, place[0])
        os.makedirs(os.path.dirname(source))
        open(source, "w").write(mutated(place))
        target = os.path.join(folder, "mutant.o")
        compiled = subprocess.run(["c++", "-std=c++20", "-I" + ROOT, *self.flags, "-c", source, "-o", target], capture_output=True)
        if compiled.returncode != 0:
            return None
        return self.passes([target if path == place[0] else known for path, known in self.rooms.items()], self.patience)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--file", default="")
    parser.add_argument("--least", type=float, default=95)
    parser.add_argument("--build", default=os.path.join(tempfile.gettempdir(), "vernier_mutants"))
    add_options(parser)
    wanted = parser.parse_args()
    rooms = rooms_of(wanted)
    every = [place for path in rooms.sources if wanted.file in path for place in places(path)]
    random.Random(wanted.seed).shuffle(every)
    bench, tally = Bench(wanted.build, rooms), {}
    survivors = 0
    for place in every:
        if sum(sum(t) for t in tally.values()) == wanted.count:
            break
        survives = bench.survives(place)
        if survives is None:
            continue
        killed, lived = tally.get(place[0], (0, 0))
        tally[place[0]] = (killed + (not survives), lived + survives)
        if survives:
            path, number, column, old, new = place
            line = open(os.path.join(ROOT, path)).read().split("\n")[number - 1].strip()
            known = is_equivalent(place)
            survivors += not known
            print(f"{path}:{number}: {old.strip()} -> {new.strip()}{' (equivalent)' if known else ''}: {line}", flush=True)
    for path, (killed, lived) in sorted(tally.items()):
        print(f"{path:36} {killed:4} killed {lived:4} survived")
    count = sum(sum(t) for t in tally.values())
    share = 100 * (count - survivors) / max(1, count)
    print(f"seed {wanted.seed}: {count} mutants, {survivors} survived that are not equivalent: {share:.1f} % killed")
    sys.exit(1 if share < wanted.least else 0)


main()
