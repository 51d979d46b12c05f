# SPDX-License-Identifier: GPL-3.0-or-later
"""Servers of one's own for tests of the fleet: a broker and a database in a folder, on a port and a socket of their own. Nothing that the
system runs is asked or touched."""

import glob
import os
import pwd
import shutil
import signal
import socket
import subprocess
import time


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def free_ports(count):
    """The first of `count` ports in a row that nobody has now, below those that the system gives away."""
    for first in range(12000 + os.getpid() % 97 * 100, 31000, 97):
        held = []
        try:
            for port in range(first, first + count):
                one = socket.socket()
                held.append(one)
                one.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
                one.bind(("127.0.0.1", port))
            return first
        except OSError:
            continue
        finally:
            for one in held:
                one.close()
    raise RuntimeError("no free ports")


class Service:
    """A process with all that it starts; killed without a word, and started again."""

    def __init__(self, name, command, log, environment=None):
        self.name, self.command, self.log, self.environment = name, command, log, environment
        self.process, self.killed_at, self.started_at = None, [], []

    def start(self):
        with open(self.log, "ab") as log:
            self.process = subprocess.Popen(
                self.command, stdout=log, stderr=log, stdin=subprocess.DEVNULL, start_new_session=True,
                env={**os.environ, **(self.environment or {})})
        self.started_at.append(time.time())

    def kill(self):
        self.killed_at.append(time.time())
        os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()

    def end(self, patience=30):
        """Told to stop; its exit status, or None where it had to be killed."""
        if self.process is None or self.process.poll() is not None:
            return self.process.returncode if self.process else None
        self.process.send_signal(signal.SIGTERM)
        try:
            return self.process.wait(patience)
        except subprocess.TimeoutExpired:
            self.kill()
            return None


def programs_missing(database):
    missing = [] if broker_program() else ["mosquitto"]
    if database == "postgres" and not postgres_folder():
        missing.append("postgresql")
    return missing


def broker_program():
    return shutil.which("mosquitto") or shutil.which("mosquitto", path="/usr/sbin:/usr/local/sbin")


def broker(folder, port):
    path = os.path.join(folder, "mosquitto.conf")
    with open(path, "w") as file:
        file.write(f"listener {port} 127.0.0.1\nallow_anonymous true\npersistence false\nmax_queued_messages 100000\n")
        if os.getuid() == 0:
            file.write("user root\n")
    return Service("broker", [broker_program(), "-c", path], os.path.join(folder, "broker.log"))


def postgres_folder():
    found = sorted(glob.glob("/usr/lib/postgresql/*/bin"))
    return found[-1] if found else None


class Postgres(Service):
    """A server in a folder, on a socket there; as root it runs as the user postgres or nobody, which it demands."""

    def __init__(self, folder):
        self.folder = os.path.join(folder, "pg")
        os.makedirs(self.folder, exist_ok=True)
        self.user, self.prefix = None, []
        if os.getuid() == 0:
            self.user = next(name for name in ("postgres", "nobody") if name in {one.pw_name for one in pwd.getpwall()})
            entry = pwd.getpwnam(self.user)
            self.prefix = ["setpriv", f"--reuid={entry.pw_uid}", f"--regid={entry.pw_gid}", "--clear-groups"]
            os.chown(self.folder, entry.pw_uid, entry.pw_gid)
        data = os.path.join(self.folder, "data")
        bin_folder = postgres_folder()
        subprocess.run(
            self.prefix + [f"{bin_folder}/initdb", "-D", data, "-U", "vernier", "-A", "trust", "-E", "UTF8", "--no-locale"],
            check=True, stdout=subprocess.DEVNULL, cwd="/")
        super().__init__(
            "database",
            self.prefix + [f"{bin_folder}/postgres", "-D", data, "-k", self.folder, "-c", "listen_addresses=", "-c",
                           "log_min_messages=error", "-c", "log_min_error_statement=panic"],
            os.path.join(folder, "postgres.log"))
        if self.user:
            with open(self.log, "ab"):
                pass
        self.url = f"postgresql://vernier@/vernier?host={self.folder}"

    def kill(self):
        """The server and each of its processes, at once."""
        self.killed_at.append(time.time())
        os.killpg(self.process.pid, signal.SIGKILL)
        # Its processes have sessions of their own.
        subprocess.run(["sh", "-c", f"for p in $(pgrep -P {self.process.pid}); do kill -9 $p; done 2>/dev/null"], check=False)
        self.process.wait()

    def ready(self, patience=60):
        end = time.time() + patience
        while time.time() < end:
            if subprocess.run([f"{postgres_folder()}/pg_isready", "-q", "-h", self.folder]).returncode == 0:
                return True
            time.sleep(0.05)
        return False

    def make_database(self):
        subprocess.run([f"{postgres_folder()}/createdb", "-h", self.folder, "-U", "vernier", "vernier"], check=True)

    def query(self, sql):
        """Rows of texts, by psql."""
        result = subprocess.run(
            [f"{postgres_folder()}/psql", "-h", self.folder, "-U", "vernier", "-d", "vernier", "-AtqF", "\x1f", "-R", "\x1e", "-c", sql],
            check=True, capture_output=True, text=True)
        return [row.split("\x1f") for row in result.stdout.rstrip("\n").split("\x1e") if row]
