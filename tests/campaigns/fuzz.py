"""Fuzzes every reader of foreign bytes: fuzz.py SECONDS [READER...].

So many seconds each, as many readers at a time as there are processors. What is found interesting stays in
build/campaign/corpus/READER for the next time; an input that fails stands in build/campaign/findings. The inputs of
tests/fuzz/seeds, the goldens and the files of the repository are where each begins.
"""

import concurrent.futures
import glob
import os
import re
import shutil
import subprocess
import sys

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
FOLDER = os.path.join(SOURCE, "build", "campaign")
FUZZER = os.path.join(SOURCE, "build", "fuzz", "tests", "fuzz", "readers", "fuzz_readers")
OWN = ("program", "modbus") # with programs of their own, of the preset host
HANGS_S = 30

# Files of the repository that a reader knows.
FILES = {
    "dialects": ("tests/golden/*.ngc", "tests/programs/*.ngc", "tests/fuzz/seeds/editor/*"),
    "machine": ("host/examples/*.ini", "tests/golden/*.ini"),
    "tools": ("tests/golden/*.tbl", "host/examples/*.tbl"),
    "parameters": ("tests/golden/*.var",),
    "correction": ("host/examples/*.csv",),
    "inject": ("host/examples/*.inject", "host/inject/README.md"),
}


def run(*command, **environment):
    return subprocess.run(command, capture_output=True, text=True, check=False, cwd=SOURCE, env=dict(os.environ, **environment))


def build():
    for command in (("cmake", "--preset", "fuzz", "-G", "Ninja"), ("cmake", "--build", "--preset", "fuzz", "--target", "fuzz_readers")):
        done = run(*command)
        if done.returncode != 0:
            sys.exit(f"{' '.join(command)} failed: {done.stdout[-2000:]}{done.stderr[-2000:]}")


def own_command(name, seconds):
    program = os.path.join(SOURCE, "build", "host", "tests", "fuzz", "fuzz_" + name)
    script = os.path.join(SOURCE, "tests", "fuzz", "fuzz_long")
    return [script, program, os.path.join(FOLDER, "corpus", name)], {"TAKT_FUZZ_SECONDS": str(seconds), "TAKT_SOURCE": SOURCE}


def seeds(name):
    folder = os.path.join(FOLDER, "seeds", name)
    os.makedirs(folder, exist_ok=True)
    kept = os.path.join(SOURCE, "tests", "fuzz", "seeds", name, "*")
    for pattern in (kept, *(os.path.join(SOURCE, f) for f in FILES.get(name, ()))):
        for path in glob.glob(pattern):
            shutil.copy(path, folder)
    return folder


def command(name, seconds):
    corpus = os.path.join(FOLDER, "corpus", name)
    os.makedirs(corpus, exist_ok=True)
    options = [f"-max_total_time={seconds}", "-max_len=4096", f"-timeout={HANGS_S}", "-rss_limit_mb=2048", "-use_value_profile=1", "-close_fd_mask=3"]
    options += [f"-artifact_prefix={os.path.join(FOLDER, 'findings', name)}-", "-error_exitcode=1", "-timeout_exitcode=1"]
    return [FUZZER, *options, corpus, seeds(name)], {"TAKT_FUZZ_READER": name}


def fuzz(name, seconds):
    """0: nothing was found."""
    words, environment = own_command(name, seconds) if name in OWN else command(name, seconds)
    done = run(*words, **environment)
    counts = re.findall(r"#(\d+)\s.*cov: (\d+).*corp: (\d+)", done.stderr)
    tried = "{} inputs, {} edges, corpus of {}".format(*counts[-1]) if counts else "nothing"
    print(f"{name:12} {'held' if done.returncode == 0 else 'FINDING'}: {tried}", flush=True)
    if done.returncode != 0:
        print("\n".join(line for line in done.stderr.splitlines() if re.search(r"ERROR|runtime error|SUMMARY|Test unit|^    #[0-6] ", line)), flush=True)
    return int(done.returncode != 0)


def main():
    seconds = int(float(sys.argv[1]))
    os.makedirs(os.path.join(FOLDER, "findings"), exist_ok=True)
    build()
    names = sys.argv[2:] or [*run(FUZZER).stdout.split(), *OWN]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        findings = sum(pool.map(lambda name: fuzz(name, seconds), names))
    print(f"{len(names)} readers, {seconds} s each: {findings} findings")
    sys.exit(findings > 0)


main()
