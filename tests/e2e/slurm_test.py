"""deploy/slurm on a real Slurm of two nodes on this machine: tasks that are killed, whose server is killed,
that Slurm requeues and whose node is lost run again; the gathered data set is byte for byte the one that a
single run without faults makes, and so are folds that are trained and their figures. Needs root,
slurmctld, slurmd and munge."""

import contextlib
import filecmp
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import tempfile
import time
import unittest

import tools

SLURM = tools.SOURCE / "deploy/slurm"
SHARDS = 6
# So many that a shard takes seconds: a fault must find it begun and not done.
RECIPE = """seed: 7
reactions { each_class {} }
reactions { mixes { count: 600 } }
output { formats: FORMAT_NPY }
"""
# The training set: who leads does what a sample does, and each follower what another sample does.
SUBJECTS = ("ann", "bo", "cy")
ANSWERS = {"kick": "push", "push": "kick", "shake_hands": "shake_hands"}
# A network so small that an epoch takes a tenth of a second, and enough of them to be struck within.
TRAINING = [word for setting in (
    "epochs=40", "batch=16", "generator.slice_features=10", "generator.encoder_hidden=8",
    "generator.attention=8", "discriminator.hidden=8") for word in ("--set", setting)]
LONGEST_RUN = 600  # seconds, on a busy machine


def wait_for(what, condition):
    """Looks ten times a second until the condition is true; returns its value."""
    end = time.monotonic() + LONGEST_RUN
    while time.monotonic() < end:
        value = condition()
        if value:
            return value
        time.sleep(0.1)
    raise AssertionError(f"waited {LONGEST_RUN} s for {what}")


class Cluster:
    """A controller and two nodes of one core each, all on this machine, in a folder of their own."""

    NODES = ("first", "second")

    def __init__(self, folder, stack):
        self._folder = folder
        self._stack = stack
        self._nodes = {}
        controller, *nodes = tools.free_ports(3)
        (folder / "state").mkdir()
        key = folder / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o400)
        host = socket.gethostname().split(".")[0]
        lines = [
            "ClusterName=test", f"SlurmctldHost={host}(127.0.0.1)", f"SlurmctldPort={controller}",
            "SlurmUser=root", "SlurmdUser=root",
            # Requeued tasks may begin once their old credentials are void: in 5 s, not in 2 minutes.
            f"AuthInfo=socket={folder}/munge.sock,cred_expire=5",
            f"StateSaveLocation={folder}/state", f"SlurmdSpoolDir={folder}/spool-%n",
            f"SlurmctldPidFile={folder}/slurmctld.pid", f"SlurmdPidFile={folder}/slurmd-%n.pid",
            "ProctrackType=proctrack/pgid", "TaskPlugin=task/none", "MpiDefault=none",
            "SelectType=select/cons_tres", "SelectTypeParameters=CR_Core", "ReturnToService=2",
            "SlurmdTimeout=6", "KillWait=5", "SchedulerParameters=sched_interval=1",
            "SlurmdParameters=config_overrides",
            *(f"NodeName={name} NodeHostname={host} NodeAddr=127.0.0.1 Port={port} CPUs=1"
              for name, port in zip(self.NODES, nodes)),
            "PartitionName=all Nodes=ALL Default=YES State=UP"]
        (folder / "slurm.conf").write_text("\n".join(lines) + "\n")
        self.environment = {**os.environ, "SLURM_CONF": str(folder / "slurm.conf"),
                            "PATH": f"{tools.PROGRAMS}:{os.environ['PATH']}"}
        self._start("munged", "--foreground", "--force", f"--socket={folder}/munge.sock",
                    f"--key-file={key}", f"--pid-file={folder}/munge.pid",
                    f"--seed-file={folder}/munge.seed", f"--log-file={folder}/munge.log")
        wait_for("munge", (folder / "munge.sock").exists)
        self._start("slurmctld", "-D", "-i")
        for name in self.NODES:
            self.start_node(name)
        wait_for("two idle nodes", lambda: self.run("sinfo", "-h", "-o", "%D %t") == "2 idle")

    def _start(self, *command):
        log = self._stack.enter_context(open(self._folder / "daemons.log", "a", encoding="utf-8"))
        process = subprocess.Popen(command, stdout=log, stderr=log, env=self.environment,
                                   start_new_session=True)
        self._stack.callback(process.wait, timeout=tools.STOP_SECONDS)
        self._stack.callback(process.terminate)
        return process

    def start_node(self, name):
        self._nodes[name] = self._start("slurmd", "-D", "-N", name)

    def lose_node(self, name, process):
        """As if the power of a node that runs the process had failed: nobody there is left to tell."""
        line = [process]
        while line[-1] > 1:  # the process, the task's script, Slurm's own process for the task
            line.append(parent_of(line[-1]))
        for victim in (*line[2:0:-1], self._nodes[name].pid, process):
            os.kill(victim, signal.SIGKILL)
        for entry in pathlib.Path("/proc").glob("[0-9]*"):
            with contextlib.suppress(OSError):
                if f"SLURMD_NODENAME={name}".encode() in (entry / "environ").read_bytes().split(b"\0"):
                    os.kill(int(entry.name), signal.SIGKILL)

    def run(self, *command):
        result = tools.run(*command, env=self.environment)
        assert result.returncode == 0, f"{command}: {result.stdout}{result.stderr}"
        return result.stdout.strip()

    def node_of(self, task):
        return self.run("squeue", "-h", "-o", "%N", "-j", task)


def parent_of(process):
    stat = pathlib.Path(f"/proc/{process}/stat").read_text()
    return int(stat.rpartition(")")[2].split()[1])


def pids_of_task(job, shard, program):
    """The processes of a program that a task of an array runs."""
    found = []
    for entry in pathlib.Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            words = (entry / "cmdline").read_bytes().split(b"\0")
            environment = (entry / "environ").read_bytes().split(b"\0")
            if (words[0].endswith(program.encode())
                    and f"SLURM_ARRAY_JOB_ID={job}".encode() in environment
                    and f"SLURM_ARRAY_TASK_ID={shard}".encode() in environment):
                found.append(int(entry.name))
    return found


def contents(folder):
    """The files of a data set, without the shards, journal and logs that led to it."""
    return sorted(file.relative_to(folder).as_posix() for file in folder.rglob("*")
                  if file.is_file() and not file.relative_to(folder).parts[0].startswith(
                      ("shard-", ".duet-batch", "logs")))


def timeless(folder):
    """The files that training and measuring leave, without what tells when and how long they ran."""
    found = {}
    for file in sorted(folder.rglob("*")):
        name = file.relative_to(folder)
        # The state from which a killed training goes on holds its times among the rest.
        if not file.is_file() or name.parts[0] == "logs" or name.name == "state":
            continue
        content = file.read_bytes()
        if file.name == "log.csv":
            content = re.sub(rb",[^,\n]*$", b"", content, flags=re.MULTILINE)
        elif file.name == "manifest.json":
            content = re.sub(rb"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", b"", content)
        found[name.as_posix()] = content
    return found


def make_data_set(folder):
    """Writes the data set `folder`/studio; returns its path."""
    captures = folder / "captures"
    captures.mkdir()
    rows = ["leader\tfollower\tlabel\tsubjects"]
    for subject in SUBJECTS:
        for label, answer in ANSWERS.items():
            names = [f"{subject}_{label}_{role}.bvh" for role in ("leader", "follower")]
            for name, sample in zip(names, (label, answer)):
                shutil.copy(tools.sample(sample), captures / name)
            rows.append("\t".join((*names, label, subject)))
    (captures / "pairs.tsv").write_text("\n".join(rows) + "\n", encoding="utf-8")
    tools.run(tools.PROGRAMS / "duet-import", "--from", captures, "--out", folder / "studio").check_returncode()
    return folder / "studio"


class SlurmTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        stack = contextlib.ExitStack()
        cls.addClassCleanup(stack.close)
        cls.folder = pathlib.Path(stack.enter_context(tempfile.TemporaryDirectory()))
        cls.cluster = Cluster(cls.folder, stack)

    def strike_node(self, task, process):
        """Takes the power from the task's node, and starts the node again once Slurm has missed it."""
        node = self.cluster.node_of(task)
        self.cluster.lose_node(node, process)
        wait_for("the node to be missed",
                 lambda: "down" in self.cluster.run("sinfo", "-h", "-n", node, "-o", "%t"))
        self.cluster.start_node(node)

    def wait_for_end(self, job):
        ended = wait_for(f"job {job}", lambda: re.search(
            "JobState=(COMPLETED|FAILED|CANCELLED)",
            self.cluster.run("scontrol", "show", "job", job)))
        self.assertEqual(ended[1], "COMPLETED")

    def settled(self, out, shard):
        """How many items of a shard are in its journal."""
        index = out / f"shard-{shard}-of-{SHARDS}"
        return sum(1 for _ in index.rglob("*.npy"))

    def kill(self, job, shard, program):
        for process in wait_for(f"{program} of {shard}",
                                lambda: pids_of_task(job, shard, program)):
            os.kill(process, signal.SIGKILL)

    def restarts(self, job, shard):
        found = re.search(r"Restarts=(\d+)",
                          self.cluster.run("scontrol", "show", "job", f"{job}_{shard}"))
        return int(found[1])

    def test_faults_leave_no_trace_in_the_data_set(self):
        recipe = self.folder / "recipe.textproto"
        recipe.write_text(RECIPE)
        words = [tools.SOURCE / "samples", "--recipe", recipe, "--quiet"]
        whole = self.folder / "whole"
        with tools.running_server() as server:
            result = tools.run(tools.PROGRAMS / "duet", "batch", *words, "--out", whole,
                               "--server", server.address, timeout=LONGEST_RUN)
            self.assertEqual(result.returncode, 0, result.stderr)

        out = self.folder / "set"
        said = self.cluster.run(SLURM / "submit_batch.sh", str(SHARDS), out, "--cpus-per-task=1",
                                "--", *words, "--max-in-flight", "2")
        job, gather = re.fullmatch(r"shards (\d+), gather (\d+)", said).groups()

        # Each fault strikes a shard that has begun and is not done.
        def begun(shard):
            wait_for(f"items of shard {shard}", lambda: self.settled(out, shard) > 3)
        begun(0)
        self.kill(job, 0, "duet")
        begun(1)
        self.kill(job, 1, "duet-server")
        begun(2)
        self.cluster.run("scontrol", "requeue", f"{job}_2")
        begun(3)
        self.strike_node(f"{job}_3", pids_of_task(job, 3, "duet")[0])

        self.wait_for_end(gather)
        for shard in range(4):
            self.assertGreaterEqual(self.restarts(job, shard), 1, shard)
        names = contents(whole)
        self.assertGreater(len(names), 150)
        self.assertEqual(contents(out), names)
        _, different, unreadable = filecmp.cmpfiles(whole, out, names, shallow=False)
        self.assertEqual((different, unreadable), ([], []))

    def test_faults_leave_no_trace_in_trained_models(self):
        data = make_data_set(self.folder)
        folds = " ".join(SUBJECTS)
        runs = self.folder / "runs"
        said = self.cluster.run(SLURM / "submit_training.sh", data, runs, folds,
                                "--cpus-per-task=1", "--", *TRAINING)
        job, measure = re.fullmatch(r"folds (\d+), measure (\d+)", said).groups()

        # Each fault strikes a fold that is being trained.
        def begun(fold):
            log = runs / SUBJECTS[fold] / "log.csv"
            wait_for(f"epochs of fold {fold}",
                     lambda: log.exists() and log.read_text().count("\n") > 5)
        begun(0)
        self.kill(job, 0, "duet-train")
        begun(1)
        self.cluster.run("scontrol", "requeue", f"{job}_1")
        begun(2)
        self.strike_node(f"{job}_2", pids_of_task(job, 2, "duet-train")[0])

        # Meanwhile the same without Slurm.
        whole = self.folder / "whole-runs"
        one_thread = {**os.environ, "OMP_NUM_THREADS": "1"}
        for words in (("duet-train", "--data", data, "--out", whole, "--protocol", "loso", *TRAINING),
                      ("duet-eval", "folds", "--data", data, "--runs", f"trained={whole}",
                       "--subjects", *SUBJECTS, "--out", whole / "results")):
            result = tools.run(tools.PROGRAMS / words[0], *words[1:], timeout=LONGEST_RUN,
                               env=one_thread)
            self.assertEqual(result.returncode, 0, result.stderr)

        self.wait_for_end(measure)
        for fold in range(len(SUBJECTS)):
            self.assertGreaterEqual(self.restarts(job, fold), 1, fold)
        expected, found = timeless(whole), timeless(runs)
        self.assertIn("ann/checkpoint/studio/1/weights.safetensors", expected)
        self.assertIn("results/10_folds.json", expected)
        self.assertEqual(list(found), list(expected))
        self.assertEqual([name for name in expected if found[name] != expected[name]], [])


if __name__ == "__main__":
    for needed in ("slurmctld", "slurmd", "sbatch", "munged"):
        if not shutil.which(needed):
            tools.skip(f"{needed} is not installed")
    if os.geteuid() != 0:
        tools.skip("needs root")
    tools.main()
