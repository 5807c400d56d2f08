"""A cluster of SLURM on this machine: a controller and some nodes with one processor each, in a folder of its own."""
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

CONFIGURATION = """
ClusterName=graze
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
SlurmUser=root
AuthType=auth/munge
CredType=cred/munge
# After five seconds a task that was put back into the queue may begin again.
AuthInfo=socket={folder}/munge/socket,cred_expire=5
ReturnToService=2
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=batch_sched_delay=0,sched_interval=1,sched_min_interval=0,bf_interval=1
SlurmdParameters=config_overrides
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/%n.log
{nodes}
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


def wait_until(true, what, seconds=30):
    end = time.monotonic() + seconds
    while not (value := true()):
        if time.monotonic() > end:
            raise TimeoutError(f"for {seconds} s: {what}")
        time.sleep(0.05)
    return value


class Cluster:
    """Its processes end, and its folder is removed, at the end of a `with`."""

    def __init__(self, nodes):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="graze-cluster-"))
        self.nodes = nodes
        self.processes = {}
        ports = free_ports(len(nodes) + 1)
        lines = [f"NodeName={node} NodeHostname={socket.gethostname()} NodeAddr=127.0.0.1 Port={port} CPUs=1"
                 for node, port in zip(nodes, ports[1:])]
        self.environment = {**os.environ, "SLURM_CONF": f"{self.folder}/slurm.conf"}
        for name in ("state", "munge", *nodes):
            (self.folder / name).mkdir(mode=0o755)
        self.folder.chmod(0o755)
        (self.folder / "slurm.conf").write_text(CONFIGURATION.format(
            host=socket.gethostname(), controller=ports[0], folder=self.folder, nodes="\n".join(lines)))
        (self.folder / "munge/key").write_bytes(os.urandom(64))
        (self.folder / "munge/key").chmod(0o600)

    def __enter__(self):
        try:
            munge = self.folder / "munge"
            self.begin("munged", "munged", "--foreground", "--force", *(
                f"--{what}={munge}/{name}" for what, name in [("key-file", "key"), ("socket", "socket"), ("pid-file", "pid"),
                                                              ("log-file", "log"), ("seed-file", "seed")]))
            wait_until((munge / "socket").exists, "munged has no socket")
            self.begin("slurmctld", "slurmctld", "-D")
            for node in self.nodes:
                self.begin_node(node)
            wait_until(lambda: self.idle() == len(self.nodes), "the nodes are not idle")
        except TimeoutError as error:
            # Some containers forbid what the daemons need. With a cluster that has come up, everything has to pass.
            self.tell()
            self.__exit__()
            print(f"SKIPPED: SLURM itself does not come up on this machine: {error}", flush=True)
            sys.exit(77)
        except BaseException:
            self.tell()
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        for pid in self.pids():
            self.kill(pid)
        for process in self.processes.values():
            process.wait()
        shutil.rmtree(self.folder)

    def begin(self, name, *words):
        with open(self.folder / f"{name}-begins.log", "ab") as log:
            self.processes[name] = subprocess.Popen(words, env={**self.environment, "CLUSTER_PROCESS": name},
                                                    stdin=subprocess.DEVNULL, stdout=log, stderr=log, start_new_session=True)

    def begin_node(self, node):
        self.begin(node, "slurmd", "-D", "-N", node)

    def idle(self):
        done = subprocess.run(["sinfo", "--noheader", "--Node", "--format=%t"], env=self.environment, text=True,
                              capture_output=True)
        return done.stdout.split().count("idle") if done.returncode == 0 else 0

    def tell(self):
        """Prints the logs."""
        for log in sorted(self.folder.glob("*.log")):
            print(f"-- {log.name}", log.read_text(errors="replace")[-3000:], sep="\n")

    def pids(self, *marks):
        """The processes of this cluster, and of its jobs, that have these variables in their environment."""
        wanted = [f"SLURM_CONF={self.folder}/slurm.conf", *marks]
        found = []
        for environ in pathlib.Path("/proc").glob("[0-9]*/environ"):
            try:
                variables = environ.read_bytes().decode(errors="replace").split("\0")
            except OSError:
                continue  # it has ended
            if all(one in variables for one in wanted) and int(environ.parent.name) != os.getpid():
                found.append(int(environ.parent.name))
        return found

    @staticmethod
    def kill(pid):
        try:
            os.kill(pid, signal.SIGKILL)
        except ProcessLookupError:
            pass

    def lose_node(self, node):
        """All processes of a node end at once, as when its power fails. The controller would find that out, but not soon."""
        for mark in (f"CLUSTER_PROCESS={node}", f"SLURMD_NODENAME={node}"):
            for pid in self.pids(mark):
                self.kill(pid)
        self.processes.pop(node).wait()
        self.run("scontrol", "update", f"nodename={node}", "state=down", "reason=lost")

    def run(self, *words):
        return subprocess.run(words, env=self.environment, text=True, capture_output=True, check=True).stdout

    def tasks(self):
        """Lines of squeue as (job_task, state, node)."""
        lines = self.run("squeue", "--noheader", "--array", "--format=%i %T %N").splitlines()
        return [(*line.split(), "")[:3] for line in lines]
