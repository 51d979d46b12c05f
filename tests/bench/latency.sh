#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Wake-up latency of vernierd beside cyclictest in the same run, and the time that a tick computes.
# Usage: tests/bench/latency.sh IMAGE_DIR [SECONDS] [BIN_DIR]; needs rt-tests, python3 and the right to SCHED_FIFO.
# Both run at the same time, at the same period and priority, each on its own processor where there are two, so
# that they meet the same disturbances. Nothing is asserted: read the ratio, not the number.
set -euo pipefail
image="${1:?image directory}" seconds="${2:-20}" bin="${3:-$(dirname "$0")/../../build/release/bin}"
command -v cyclictest >/dev/null || { echo "latency.sh: cyclictest (rt-tests) is not installed" >&2; exit 1; }
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

pin() { if [ "$(nproc)" -ge 2 ]; then taskset -c "$1" "${@:2}"; else "${@:2}"; fi; }
run_pair() { # run_pair NAME CPU_OF_VERNIERD CPU_OF_CYCLICTEST
  pin "$3" cyclictest -q -m -p 80 -i 1000 -D "$seconds" -h 100000 >"$work/$1.cyclictest" &
  local other=$!
  pin "$2" "$bin/vernierd" --image "$image" --simulate --seconds "$seconds" --json "$work/$1.json" >/dev/null
  wait "$other"
}
run_pair a 0 1
run_pair b 1 0 # processors changed over: they are not equally disturbed

python3 - "$work" <<'PY'
import json, sys
work = sys.argv[1]

def cyclictest(path):
    bins = []
    for line in open(path):
        words = line.split()
        if len(words) == 2 and words[0].isdigit():
            bins.append((int(words[0]), int(words[1])))
        if line.startswith('# Max Latencies:'):
            largest = int(words[3])
    total = sum(n for _, n in bins)
    def percentile(share):
        seen = 0
        for us, n in bins:
            seen += n
            if seen >= share * total:
                return us
        return largest
    return [percentile(0.5), percentile(0.99), percentile(0.999), largest]

keys = ['p50', 'p99', 'p999', 'max']
print(f"{'wake-up latency, us':<28}{'p50':>9}{'p99':>9}{'p99.9':>9}{'max':>11}")
for run in 'ab':
    result = json.load(open(f'{work}/{run}.json'))
    ours, theirs = [result['latency_us'][k] for k in keys], cyclictest(f'{work}/{run}.cyclictest')
    print(f"{'vernierd   run ' + run:<28}{ours[0]:>9.1f}{ours[1]:>9.1f}{ours[2]:>9.1f}{ours[3]:>11.1f}")
    print(f"{'cyclictest run ' + run:<28}{theirs[0]:>9}{theirs[1]:>9}{theirs[2]:>9}{theirs[3]:>11}")
    ratio = [a / b if b else float('nan') for a, b in zip(ours, theirs)]
    print(f"{'ratio':<28}{ratio[0]:>9.2f}{ratio[1]:>9.2f}{ratio[2]:>9.2f}{ratio[3]:>11.2f}")
    e = [result['execution_us'][k] for k in keys]
    print(f"{'execution of a tick':<28}{e[0]:>9.2f}{e[1]:>9.2f}{e[2]:>9.2f}{e[3]:>11.2f}"
          f"   ({result['ticks']} ticks, {result['overruns']} overruns)")
PY
