#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""usage: rollout_no.py BIN_DIR [--seeds 200] [--first 1] [--workers 2] [--database sqlite|postgres]

Rollouts that must say no. Each seed starts three vernierd processes with simulated axes on loopback, enters them in a registry with
their keys, and runs `vernier fleet rollout` with one disturbance drawn from the seed: addresses swapped, a board killed, deactivated,
held, given a weight of 0 or restarted at the address of another, a trial begun by hand, two callers at once, a caller killed. A
disturbance comes before the call, or out of the judge's command while a machine drawn from the seed is on trial, so that its moment is
known. After the call the boards themselves are asked. What must hold:
 - a machine that is called kept has its own board alive, with its own image confirmed and in effect (active, no fault, weights 1, not
   held);
 - no board ever has the image of another machine, on trial or confirmed;
 - exit status 0 and assurance.holds exactly where all machines are called kept; a disturbed rollout does not end so;
 - an undisturbed rollout ends with all machines kept, exit status 0.
Ends with one line of JSON: runs and calls of "kept" by disturbance, and what did not hold. Exit status 0 where all of it holds."""

import argparse
import concurrent.futures
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from services import Postgres, Service, programs_missing  # noqa: E402

MACHINE = """<machine name="small"><variables><static><k value="{scale}" nominal="0" unit=""/></static>
<machineaxes><X rotary="false" min="0" max="600" maxcorrection="0.2" maxslew="5"/>
<Y rotary="false" min="0" max="200" maxcorrection="0.2" maxslew="5"/></machineaxes></variables>
<transforms branch="tool"><sixdof n="1" X="X+k*X" Y="Y" Z="0" rX="0" rY="0" rZ="0"/></transforms></machine>
"""
BOARD = """[board]
name = "{name}"
store = "store"
public_key = "../vernier.pub"
trial_s = 30
activate = true
max_lost_ticks = 0.9
[axis.X]
high = 600
position = {{ kind = "sim" }}
output = {{ kind = "sim" }}
[axis.Y]
high = 200
position = {{ kind = "sim" }}
output = {{ kind = "sim" }}
[[link]]
kind = "modbus-tcp"
port = {port}
"""
NAMES = ["m1", "m2", "m3"]
# During a trial, by the judge's command; every one of them must end in a no.
DURING = ["kill", "deactivate", "weight", "hold", "restart-swapped", "trial-by-hand"]
BEFORE = ["swap", "dead", "deactivated", "weight-before", "trial-before", "wrong-name"]
CALLERS = ["two-callers", "caller-killed"]
LEASE_S = 4


def run(words, folder, patience=120):
    """Exit status and output; 124 where the command had to be ended."""
    try:
        done = subprocess.run(words, cwd=folder, capture_output=True, text=True, timeout=patience)
    except subprocess.TimeoutExpired:
        return 124, "too long"
    return done.returncode, done.stdout + done.stderr


class Board:
    def __init__(self, options, folder, name, board_name):
        self.options, self.folder, self.name = options, os.path.join(folder, name), name
        os.makedirs(self.folder, exist_ok=True)
        self.board_name, self.process, self.port = board_name, None, 0

    def start(self, port=0):
        with open(os.path.join(self.folder, "board.toml"), "w") as file:
            file.write(BOARD.format(name=self.board_name, port=port))
        log = os.path.join(self.folder, f"log{time.monotonic_ns()}")
        with open(log, "wb") as out:
            self.process = subprocess.Popen(
                [os.path.join(self.options.bin, "vernierd"), "--board", "board.toml", "--no-realtime"], cwd=self.folder,
                stdout=subprocess.DEVNULL, stderr=out, stdin=subprocess.DEVNULL, start_new_session=True)
        end = time.time() + 20
        while time.time() < end:
            with open(log) as file:
                for line in file:
                    if "Modbus TCP on" in line and line.endswith("\n"):
                        self.port = int(line.rsplit(":", 1)[1])
                        return self
            if self.process.poll() is not None:
                break
            time.sleep(0.02)
        raise RuntimeError(f"{self.name}: the board does not start: " + open(log).read())

    def kill(self):
        if self.process and self.process.poll() is None:
            self.process.kill()
        if self.process:
            self.process.wait()

    def alive(self):
        return self.process.poll() is None

    def url(self):
        return f"tcp://127.0.0.1:{self.port}"


class Run:
    """One seed: its boards, its registry, its disturbance."""

    def __init__(self, options, shared, room, seed, attempt):
        self.options, self.shared, self.seed = options, shared, seed
        self.draw = random.Random(seed)
        self.kind = self.draw.choice([*DURING, *BEFORE, *CALLERS, "none", "none"])
        self.at, self.victim = self.draw.randrange(3), self.draw.randrange(3)
        if self.kind in ("trial-by-hand",):
            self.victim = self.draw.choice([one for one in range(3) if one != self.at])
        self.folder = os.path.join(room, f"seed{seed}")
        os.makedirs(self.folder)
        os.symlink(os.path.join(shared, "vernier.pub"), os.path.join(self.folder, "vernier.pub"))
        same = self.draw.random() < 0.5  # boards of one name are told apart by their keys alone
        self.boards = [Board(options, self.folder, name, "board" if same else "board-" + name) for name in NAMES]
        self.registry = options.registry or os.path.join(self.folder, "fleet.db")
        self.names = [f"s{seed}.{attempt}-{name}" for name in NAMES]
        self.faults, self.took = [], True

    def vernier(self, *words, patience=120):
        return run([os.path.join(self.options.bin, "vernier"), *words], self.folder, patience)

    def told(self, board, *words):
        return self.vernier(*words, "--to", board.url(), "--key", os.path.join(self.shared, "vernier.key"))

    def expect(self, good, what):
        if not good:
            self.faults.append(f"seed {self.seed} ({self.kind}, at {self.at + 1}, board {self.victim + 1}): {what}")

    def add(self, machine, board, *more):
        status, said = self.vernier("fleet", "add", self.names[machine], "--registry", self.registry, "--url", board.url(), *more)
        self.expect(status == 0, "fleet add: " + said)

    def prepare(self):
        for i, board in enumerate(self.boards):
            board.start()
            self.add(i, board, "--trust")
            os.symlink(os.path.join(self.shared, "image_" + NAMES[i]), os.path.join(self.folder, "image_" + self.names[i]))
        target = self.boards[self.victim]
        if self.kind == "swap":
            other = (self.victim + 1) % 3
            self.add(self.victim, self.boards[other])
            self.add(other, target)
        if self.kind == "dead":
            target.kill()
        if self.kind == "deactivated":
            self.told(target, "upload", os.path.join(self.shared, "image_old"), "--confirm")
            self.wait_for(target, lambda one: one["mode"] == "active")
            self.told(target, "board", "deactivate")
        if self.kind == "weight-before":
            self.told(target, "board", "weight", "--axis", "X", "--weight", "0")
        if self.kind == "trial-before":
            self.told(target, "upload", os.path.join(self.shared, "image_old"))
        if self.kind == "wrong-name":
            self.vernier("fleet", "add", self.names[self.victim], "--registry", self.registry, "--board", "another")

    def wait_for(self, board, good, patience=10):
        end = time.time() + patience
        while time.time() < end:
            state = self.state(board)
            if state and good(state):
                return
            time.sleep(0.1)
        self.expect(False, "the board does not get ready for the disturbance")

    def state(self, board):
        path = os.path.join(self.folder, "state.json")
        status, _ = self.vernier("status", "--to", board.url(), "--json", path, patience=30)
        return json.load(open(path)) if status == 0 else None

    def disturb(self):
        """Out of the judge's command, in this process: it waits for the file that says so, and answers with another."""
        target = self.boards[self.victim]
        other = self.boards[(self.victim + 1) % 3]
        time.sleep(self.draw.uniform(0, 0.3))
        if self.kind == "kill":
            target.kill()
        if self.kind in ("deactivate", "hold"):
            # A board that has no image yet refuses both: then nothing was disturbed.
            self.took = self.told(target, "board", self.kind)[0] == 0
        if self.kind == "weight":
            self.told(target, "board", "weight", "--axis", "Y", "--weight", "0.5")
        if self.kind == "trial-by-hand":
            self.told(target, "upload", os.path.join(self.shared, "image_old"))
        if self.kind == "restart-swapped":
            ports = target.port, other.port
            target.kill(), other.kill()
            target.start(ports[1]), other.start(ports[0])

    def rollout_words(self, answer):
        judge = f"[ {{machine}} != {self.names[self.at]} ] || {{ touch judging; for i in $(seq 200); do [ -e go ] && exit 0; sleep 0.05; done; exit 3; }}"
        words = ["fleet", "rollout", f"spring-{self.names[0]}", "--registry", self.registry, "--images", "image_{machine}", "--key",
                 os.path.join(self.shared, "vernier.key"), "--signed-by", "bench", "--stages", "1,2,100%", "--watch", "0.3", "--settle", "2",
                 "--lease", str(LEASE_S), "--json", answer]
        for name in self.names:
            words += ["--machine", name]
        return [*words, "--judge", judge] if self.kind in DURING else words

    def call(self, answer="answer.json"):
        """A call; its exit status, what it said, its answer."""
        out = os.path.join(self.folder, answer + ".out")
        with open(out, "wb") as to:
            process = subprocess.Popen([os.path.join(self.options.bin, "vernier"), *self.rollout_words(answer)], cwd=self.folder, stdout=to,
                                       stderr=to, stdin=subprocess.DEVNULL)
        if self.kind in DURING:
            while process.poll() is None and not os.path.exists(os.path.join(self.folder, "judging")):
                time.sleep(0.02)
            if process.poll() is None:
                self.disturb()
                open(os.path.join(self.folder, "go"), "w").close()
        try:
            status = process.wait(timeout=120)
        except subprocess.TimeoutExpired:
            process.kill()
            status = 124
        path = os.path.join(self.folder, answer)
        return status, open(out).read(), json.load(open(path)) if os.path.exists(path) else None

    def judge_truth(self, status, said, answer, disturbed):
        states = {one["machine"]: one["state"] for one in answer["machines"]}
        kept = [i for i in range(3) if states.get(self.names[i]) == "kept"]
        for i, board in enumerate(self.boards):
            now = self.state(board) if board.alive() else None
            fingerprints = {now["confirmed"], now["trial"], now["running"]} - {None, self.shared_prints["old"]} if now else set()
            self.expect(fingerprints <= {self.shared_prints[NAMES[i]]}, f"{NAMES[i]} has an image of another machine: {fingerprints}")
            if i not in kept:
                continue
            self.expect(now is not None, f"{NAMES[i]} is called kept and its board is away")
            good = now and (now["confirmed"] == self.shared_prints[NAMES[i]] == now["running"] and now["mode"] == "active"
                            and now["fault"] == "none" and not now["holding"] and now["weight"] == 1
                            and all(axis["weight"] == 1 for axis in now["axes"].values()))
            self.expect(good, f"{NAMES[i]} is called kept and is not in effect: {now}")
        self.expect((status == 0) == (len(kept) == 3), f"exit status {status} with {len(kept)} kept: {said}")
        self.expect((status == 0) == answer["assurance"]["holds"], "assurance and exit status differ")
        self.expect(status == 2 if disturbed else status == 0, f"exit status {status}: {said}")
        return len(kept)

    def two_callers(self):
        first = subprocess.Popen([os.path.join(self.options.bin, "vernier"), *self.rollout_words("first.json")], cwd=self.folder,
                                 stdout=open(os.path.join(self.folder, "first.out"), "wb"), stderr=subprocess.STDOUT)
        time.sleep(self.draw.uniform(0, 1.0))
        status, said, answer = self.call("second.json")
        other = first.wait(timeout=120)
        first_said = open(os.path.join(self.folder, "first.out")).read()
        if sorted((status, other)) == [0, 0]:  # one after the other: nothing was at once
            return self.judge_truth(0, said, answer, False)
        self.expect(sorted((status, other)) == [0, 2], f"two callers ended with {other} and {status}: {first_said} {said}")
        refused = said if status == 2 else first_said
        self.expect("another call works on this machine" in refused, "the refusal does not say why: " + refused)
        path = os.path.join(self.folder, "second.json" if status == 0 else "first.json")
        return self.judge_truth(0, said, json.load(open(path)), False)

    def caller_killed(self):
        process = subprocess.Popen([os.path.join(self.options.bin, "vernier"), *self.rollout_words("first.json")], cwd=self.folder,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(self.draw.uniform(0.05, 2.0))
        process.send_signal(signal.SIGKILL)
        process.wait()
        time.sleep(LEASE_S + 0.5)
        return self.judge_truth(*self.call(), False)

    def go(self):
        self.shared_prints = self.options.prints
        try:
            self.prepare()
            if self.kind == "two-callers":
                kept = self.two_callers()
            elif self.kind == "caller-killed":
                kept = self.caller_killed()
            else:
                status, said, answer = self.call()
                self.expect(answer is not None, f"no answer, exit status {status}: {said}")
                kept = self.judge_truth(status, said, answer, self.kind != "none" and self.took) if answer else 0
        except Exception as error:  # a run that cannot be judged is a run that failed
            self.faults.append(f"seed {self.seed} ({self.kind}): {error!r}")
            kept = 0
        finally:
            for board in self.boards:
                board.kill()
        if not self.faults and not self.options.keep:
            shutil.rmtree(self.folder, ignore_errors=True)
        return self.kind, kept, self.faults


def go_patiently(options, folder, seed):
    """A run; again, twice at most, where a board latched an overrun: this computer was busy, and the board is right to stop."""
    for attempt in range(3):
        room = os.path.join(folder, f"attempt{attempt}")
        os.makedirs(room, exist_ok=True)
        kind, kept, faults = Run(options, folder, room, seed, attempt).go()
        if not any("overrun" in one for one in faults):
            break
    return kind, kept, faults, attempt


def make_images(options, folder):
    """A key, and an image for each machine and an older one; their fingerprints."""
    vernier = os.path.join(options.bin, "vernier")
    subprocess.run([vernier, "keys", "-o", folder], check=True, stdout=subprocess.DEVNULL)
    prints = {}
    for i, name in enumerate([*NAMES, "old"]):
        with open(os.path.join(folder, name + ".xml"), "w") as file:
            file.write(MACHINE.format(scale=1e-5 * (i + 1)))
        image = os.path.join(folder, "image_" + name)
        subprocess.run([vernier, "compile", os.path.join(folder, name + ".xml"), "-o", image], check=True, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)
        with open(os.path.join(image, "machine.vimg"), "rb") as file:
            head = file.read(64)
        prints[name] = f"{int.from_bytes(head[options.fingerprint_at:options.fingerprint_at + 8], 'little'):016x}"
    return prints


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("bin")
    parser.add_argument("--seeds", type=int, default=200)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--database", choices=["sqlite", "postgres"], default="sqlite")
    parser.add_argument("--keep", help="folder for everything, kept; default: a temporary one")
    options = parser.parse_args()
    options.bin = os.path.abspath(options.bin)
    if options.database == "postgres" and programs_missing("postgres"):
        print("rollout_no: Skipped\nnot installed: " + " ".join(programs_missing("postgres")))
        return 77
    options.fingerprint_at = FINGERPRINT_AT
    folder = options.keep or tempfile.mkdtemp(prefix="vernier_rollout_")
    os.makedirs(folder, exist_ok=True)
    os.chmod(folder, 0o755)
    options.prints = make_images(options, folder)
    options.registry, postgres = None, None
    begin, by_kind, faults, repeated = time.time(), {}, [], 0
    try:
        if options.database == "postgres":
            postgres = Postgres(folder)
            postgres.start()
            postgres.ready()
            postgres.make_database()
            options.registry = postgres.url
        with concurrent.futures.ThreadPoolExecutor(options.workers) as pool:
            seeds = range(options.first, options.first + options.seeds)
            for kind, kept, wrong, repeats in pool.map(lambda seed: go_patiently(options, folder, seed), seeds):
                repeated += repeats
                entry = by_kind.setdefault(kind, {"runs": 0, "kept": 0})
                entry["runs"] += 1
                entry["kept"] += kept
                faults += wrong
    finally:
        if postgres:
            postgres.kill()
    print(json.dumps({"seeds": options.seeds, "first": options.first, "database": options.database, "seconds": round(time.time() - begin, 1),
                      "disturbances": by_kind, "repeated_for_overruns": repeated, "wrong": len(faults), "examples": faults[:5], "good": not faults}))
    if not options.keep and not faults:
        shutil.rmtree(folder, ignore_errors=True)
    return 0 if not faults else 1


# Of ImageHeader::fingerprint in tables/image_format.h.
FINGERPRINT_AT = 32

if __name__ == "__main__":
    sys.exit(main())
