#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""usage: diagnoses.py BIN_DIR [--machines 1000] [--workers 2] [--kills 20] [--seed 1] [--database postgres|sqlite] [--only-killed]

Mass work: a `vernier diagnose` for each of many machines, each with measurements of its own (those of NISTIR 6415 with other noise), through `vernier
fleet enqueue` and `work`. Workers' processes are killed (SIGKILL) at moments drawn from the seed and begun again; the database's server too. Every machine must have one
answer, its own, from one attempt. Then the same with one worker and no kills, for the wall time. Ends with one line of JSON; exit
status 0 where all of it holds, 77 where a server is not installed."""

import argparse
import json
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from services import Postgres, Service, programs_missing  # noqa: E402

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../.."))
DATA = os.path.join(ROOT, "tests/data/real/nist_probe")


def parse():
    parser = argparse.ArgumentParser()
    parser.add_argument("bin")
    parser.add_argument("--machines", type=int, default=1000)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--database", choices=["postgres", "sqlite"], default="postgres")
    parser.add_argument("--only-killed", action="store_true", help="without the run of one worker")
    return parser.parse_args()


def surveys(folder, count, seed):
    """Each machine's readings: the published ones with noise of its own; the first column after the header tells whose."""
    draw = random.Random(seed)
    with open(os.path.join(DATA, "meas.csv")) as file:
        lines = file.read().splitlines()
    header = next(i for i, line in enumerate(lines) if line and not line.startswith("#"))
    reading = [i for i, name in enumerate(lines[header].split(",")) if name.split("[")[0] in ("x", "y", "z", "d", "length")]
    for machine in range(count):
        rows = lines[:header + 1]
        for line in lines[header + 1:]:
            if not line or line.startswith("#"):
                continue
            cells = line.split(",")
            for column in reading:
                if cells[column]:
                    cells[column] = f"{float(cells[column]) + draw.gauss(0, 1e-4):.7f}"
            rows.append(",".join(cells))
        with open(os.path.join(folder, f"machine-{machine}.csv"), "w") as file:
            file.write("\n".join(rows) + "\n")


class Batch:
    def __init__(self, options, folder, registry, name):
        self.options, self.folder, self.registry, self.name = options, folder, registry, name
        self.vernier = os.path.join(options.bin, "vernier")
        self.answers = os.path.join(folder, name)
        os.makedirs(self.answers)
        command = (f"echo {{machine}} >>'{self.answers}/begun' && '{self.vernier}' diagnose '{DATA}/machine.xml' '{folder}'/{{machine}}.csv "
                   f"--json '{self.answers}'/{{machine}}.json && echo {{machine}} >>'{self.answers}/ended'")
        subprocess.run([self.vernier, "fleet", "enqueue", name, command, "--registry", registry], check=True, stdout=subprocess.DEVNULL)

    def worker(self, number):
        return Service(f"worker {number}", [self.vernier, "fleet", "work", self.name, "--registry", self.registry, "--lease", "4", "--attempts", "50"],
                       os.path.join(self.folder, f"{self.name}{number}.log"))

    def state(self):
        result = subprocess.run([self.vernier, "fleet", "jobs", self.name, "--registry", self.registry, "--json", "-"],
                                check=True, capture_output=True, text=True)
        return json.loads(result.stdout)["batches"][0]

    def judge(self):
        state = self.state()
        jobs = state["jobs"]
        answered = 0
        for job in jobs:
            path = os.path.join(self.answers, job["machine"] + ".json")
            with open(path) as file:
                answered += "verdict" in file.read()
        with open(os.path.join(self.answers, "begun")) as file:
            begun = file.read().split()
        with open(os.path.join(self.answers, "ended")) as file:
            ended = file.read().split()
        once = {job["machine"] for job in jobs if job["state"] == "done"}
        return {"jobs": len(jobs), "done": state["done"], "failed": state["failed"], "answers": answered, "attempts": sum(job["attempt"] for job in jobs),
                "begun": len(begun), "ended": len(ended),
                # More than one end needs more than one attempt: a worker that was killed between the end and its writing down.
                "repeated_ends": len(ended) - len(set(ended)),
                "good": len(once) == len(jobs) == answered == self.options.machines == len(set(ended)) and state["failed"] == 0}


def run_killed(options, folder, registry, postgres):
    batch = Batch(options, folder, registry, "killed")
    draw = random.Random(options.seed)
    workers = [batch.worker(number) for number in range(options.workers)]
    begin = time.time()
    for one in workers:
        one.start()
    kills = {"workers": 0, "database": 0}
    wanted = options.kills
    next_kill = begin + draw.uniform(0.3, 1.5)
    while any(one.process.poll() is None for one in workers):
        time.sleep(0.02)
        if wanted == 0 or time.time() < next_kill:
            continue
        wanted -= 1
        next_kill = time.time() + draw.uniform(0.3, 4)
        if postgres and draw.random() < 0.15:
            postgres.kill()
            time.sleep(draw.uniform(0, 1))
            postgres.start()
            postgres.ready()
            kills["database"] += 1
            continue
        one = draw.choice(workers)
        if one.process.poll() is None:
            one.kill()
            kills["workers"] += 1
            one.start()
    seconds = time.time() - begin
    return {"kills": kills, "seconds": round(seconds, 1), **batch.judge()}


def run_alone(options, folder, registry):
    batch = Batch(options, folder, registry, "alone")
    begin = time.time()
    one = batch.worker(0)
    one.start()
    one.process.wait()
    return {"seconds": round(time.time() - begin, 1), **batch.judge()}


def main():
    options = parse()
    missing = [name for name in programs_missing(options.database) if name != "mosquitto"]
    if missing:
        print(f"diagnoses: Skipped\nnot installed: {' '.join(missing)}")
        return 77
    folder = tempfile.mkdtemp(prefix="vernier_diagnoses_")
    os.chmod(folder, 0o755)
    postgres = Postgres(folder) if options.database == "postgres" else None
    try:
        registry = os.path.join(folder, "fleet.db")
        if postgres:
            postgres.start()
            postgres.ready()
            postgres.make_database()
            registry = postgres.url
        for machine in range(options.machines):
            subprocess.run([os.path.join(options.bin, "vernier"), "fleet", "add", f"machine-{machine}", "--registry", registry], check=True)
        surveys(folder, options.machines, options.seed)
        answer = {"machines": options.machines, "workers": options.workers, "seed": options.seed, "database": options.database,
                  "killed": run_killed(options, folder, registry, postgres)}
        if not options.only_killed:
            answer["alone"] = run_alone(options, folder, registry)
    finally:
        if postgres:
            postgres.kill()
    answer["good"] = all(answer[key]["good"] for key in ("killed", "alone") if key in answer)
    print(json.dumps(answer))
    shutil.rmtree(folder, ignore_errors=True)
    return 0 if answer["good"] else 1


if __name__ == "__main__":
    sys.exit(main())
