#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""usage: diagnoses.py BIN_DIR [--machines 1000] [--jobs 2] [--kills 20] [--seed 1] [--scheduler parallel|slurm] [--database sqlite|postgres]

A batch of `vernier diagnose`: each machine has measurements of its own (those of NISTIR 6415 with other noise). GNU parallel, or a Slurm of
this program's own with two nodes, runs it. parallel with all its jobs, or a node's slurmd, is killed (SIGKILL) at moments drawn from the seed and started again, and `fleet
collect` is called in between. At the end each machine has one booked answer, its own, and a further collect changes nothing. Prints a line of JSON; exit status
0 if all of it holds, 77 if a program is not installed."""

import argparse
import getpass
import json
import os
import random
import shutil
import socket
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from services import Postgres, Service, free_ports, programs_missing  # noqa: E402

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../.."))
DATA = os.path.join(ROOT, "tests/data/real/nist_probe")


def parse():
    parser = argparse.ArgumentParser()
    parser.add_argument("bin")
    parser.add_argument("--machines", type=int, default=1000)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--scheduler", choices=["parallel", "slurm"], default="parallel")
    parser.add_argument("--database", choices=["postgres", "sqlite"], default="sqlite")
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


class Parallel:
    """GNU parallel with the script of the batch."""

    programs = ("parallel",)

    def __init__(self, options, folder, batch):
        self.run = Service("parallel", [os.path.join(batch, "parallel.sh"), "-j", str(options.jobs)], os.path.join(folder, "parallel.log"))

    def start(self):
        self.run.start()

    def ended(self):
        return self.run.process.poll() is not None

    def disturb(self, draw):
        self.run.kill()
        self.run.start()

    def stop(self):
        if self.run.process and not self.ended():
            self.run.kill()


class Slurm:
    """munge, slurmctld and two slurmd of one's own, in a folder and on ports of their own."""

    programs = ("munged", "slurmctld", "slurmd", "sbatch", "squeue")

    def __init__(self, options, folder, batch):
        self.folder = os.path.join(folder, "slurm")
        self.batch, self.started, self.nodes = batch, [], []
        for name in ("", "state", "spool-n1", "spool-n2", "munge"):
            os.makedirs(os.path.join(self.folder, name))
        key = os.path.join(self.folder, "munge/key")
        with open(key, "wb") as file:
            file.write(os.urandom(1024))
        os.chmod(key, 0o400)
        port = free_ports(3)
        host, user = socket.gethostname().split(".")[0], getpass.getuser()
        lines = ["ClusterName=test", f"SlurmctldHost={host}(127.0.0.1)", f"SlurmUser={user}", f"SlurmdUser={user}", f"SlurmctldPort={port}",
                 "AuthType=auth/munge", f"AuthInfo=socket={self.folder}/munge/socket", f"StateSaveLocation={self.folder}/state",
                 f"SlurmdSpoolDir={self.folder}/spool-%n", f"SlurmctldPidFile={self.folder}/ctld.pid", f"SlurmdPidFile={self.folder}/%n.pid",
                 "ProctrackType=proctrack/pgid", "TaskPlugin=task/none", "SelectType=select/cons_tres", "SelectTypeParameters=CR_CPU",
                 "ReturnToService=2", "MpiDefault=none", "SlurmdParameters=config_overrides", "SchedulerParameters=sched_interval=1,batch_sched_delay=0",
                 *(f"NodeName=n{n} NodeHostname={host} NodeAddr=127.0.0.1 Port={port + n} CPUs=1" for n in (1, 2)),
                 "PartitionName=all Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP"]
        self.conf = os.path.join(self.folder, "slurm.conf")
        with open(self.conf, "w") as file:
            file.write("\n".join(lines) + "\n")
        self.environment = {**os.environ, "SLURM_CONF": self.conf}
        self.job = None

    def service(self, name, command):
        one = Service(name, command, os.path.join(self.folder, name + ".log"), {"SLURM_CONF": self.conf})
        one.start()
        self.started.append(one)
        return one

    def ask(self, *command):
        return subprocess.run(command, env=self.environment, capture_output=True, text=True, timeout=60)

    def start(self):
        there = {name: f"{self.folder}/munge/{name}" for name in ("socket", "pid", "log", "seed", "key")}
        self.service("munged", ["munged", "--foreground", "--force", f"--socket={there['socket']}", f"--key-file={there['key']}",
                                f"--pid-file={there['pid']}", f"--log-file={there['log']}", f"--seed-file={there['seed']}"])
        wait_for(lambda: os.path.exists(there["socket"]), "munged")
        self.service("slurmctld", ["slurmctld", "-D", "-f", self.conf])
        self.nodes = [self.service(f"slurmd-n{n}", ["slurmd", "-D", "-N", f"n{n}", "-f", self.conf]) for n in (1, 2)]
        wait_for(lambda: self.ask("sinfo", "-h", "-o", "%D %t").stdout.strip() == "2 idle", "two idle nodes")
        self.submit()

    def submit(self):
        done = self.ask("sbatch", "--parsable", os.path.join(self.batch, "slurm.sh"))
        if done.returncode:
            raise RuntimeError("sbatch: " + done.stderr)
        self.job = done.stdout.strip()

    def ended(self):
        queue = self.ask("squeue", "-h", "-j", self.job)
        return not queue.stdout.strip()

    def disturb(self, draw):
        """A node's daemon is killed, and the tasks that run are ended as by an operator."""
        node = draw.choice(self.nodes)
        node.kill()
        self.ask("scancel", "--signal=KILL", "--batch", self.job)
        node.start()

    def stop(self):
        if self.job:
            self.ask("scancel", self.job)
            wait_for(self.ended, "end of the tasks")
        for one in reversed(self.started):
            if one.process.poll() is None:
                one.end() if one.name == "slurmctld" else one.kill()


def wait_for(condition, what, patience=60):
    end = time.time() + patience
    while not condition():
        if time.time() > end:
            raise RuntimeError(f"no {what} within {patience} s")
        time.sleep(0.2)


def main():
    options = parse()
    kind = {"parallel": Parallel, "slurm": Slurm}[options.scheduler]
    missing = [name for name in programs_missing(options.database) if name != "mosquitto"]
    missing += [name for name in kind.programs if not shutil.which(name, path=os.environ["PATH"] + ":/usr/sbin:/sbin")]
    if missing:
        print(f"diagnoses: Skipped\nnot installed: {' '.join(missing)}")
        return 77
    os.environ["PATH"] += ":/usr/sbin:/sbin"
    folder = tempfile.mkdtemp(prefix="vernier_diagnoses_")
    os.chmod(folder, 0o755)
    vernier = os.path.join(options.bin, "vernier")
    postgres = Postgres(folder) if options.database == "postgres" else None
    scheduler = None
    try:
        registry = os.path.join(folder, "fleet.db")
        if postgres:
            postgres.start()
            postgres.ready()
            postgres.make_database()
            registry = postgres.url
        for machine in range(options.machines):
            subprocess.run([vernier, "fleet", "add", f"machine-{machine}", "--registry", registry], check=True)
        surveys(folder, options.machines, options.seed)
        # A folder with a blank and a quote: nothing is read by a shell.
        batch = os.path.join(folder, "it's a batch")
        subprocess.run([vernier, "fleet", "batch", "night", "-o", batch, "--scheduler", options.scheduler, "--registry", registry, "diagnose",
                        os.path.join(DATA, "machine.xml"), os.path.join(folder, "{machine}.csv")], check=True, stdout=subprocess.DEVNULL)

        def collect():
            done = subprocess.run([vernier, "fleet", "collect", batch, "--registry", registry, "--json", "-"], capture_output=True, text=True)
            return done.returncode, json.loads(done.stdout)

        def diagnosed(machine):
            done = subprocess.run([vernier, "diagnose", os.path.join(DATA, "machine.xml"), os.path.join(folder, machine + ".csv"), "--json", "-"],
                                  capture_output=True, text=True)
            return json.loads(done.stdout)

        draw = random.Random(options.seed)
        begin = time.time()
        scheduler = kind(options, folder, batch)
        scheduler.start()
        booked, kills, restarts = 0, 0, 0
        next_kill = begin + draw.uniform(0.3, 0.6)
        while True:
            if scheduler.ended():
                status, answer = collect()
                booked += answer["booked"]
                if status == 0 or restarts > options.kills:
                    break
                # Tasks that were killed are repeated by calling the script again.
                restarts += 1
                scheduler.submit() if options.scheduler == "slurm" else scheduler.start()
            if kills < options.kills and time.time() >= next_kill:
                scheduler.disturb(draw)
                kills += 1
                booked += collect()[1]["booked"]
                next_kill = time.time() + draw.uniform(0.3, 0.6 + 2.4 * (options.machines > 100))
            time.sleep(0.05)
        seconds = time.time() - begin
        again, after = collect()
        listed = subprocess.run([vernier, "fleet", "answers", "--registry", registry, "--json", "-"], check=True, capture_output=True, text=True)
        answers = json.loads(listed.stdout)["answers"]
        # Each machine has other measurements: the answer of another machine differs.
        looked_at = draw.sample(answers, min(len(answers), 50))
        own = sum(one["result"] == diagnosed(one["machine"]) for one in looked_at)
        different = len({json.dumps(one["result"]) for one in answers})
        result = {"machines": options.machines, "scheduler": options.scheduler, "database": options.database, "seed": options.seed, "kills": kills,
                  "restarts": restarts, "seconds": round(seconds, 1), "booked": booked, "answers": len(answers), "own": f"{own} of {len(looked_at)}", "different": different}
        result["good"] = (again == 0 and after["booked"] == 0 and after["booked_before"] == options.machines == booked == different == len(answers) and own == len(looked_at)
                          and len({one["machine"] for one in answers}) == len(answers) and (kills > 0 or options.kills == 0))
    finally:
        if scheduler:
            scheduler.stop()
        if postgres:
            postgres.kill()
    print(json.dumps(result))
    shutil.rmtree(folder, ignore_errors=True)
    return 0 if result["good"] else 1


if __name__ == "__main__":
    sys.exit(main())
