"""Output files: complete or not there, in the form their readers expect."""

import os
import re
import signal
import subprocess
import xml.etree.ElementTree as xml

import takt_test as t

PROGRAM = t.write("part.ngc", "G21 G90 F1200\n" + "".join(f"G1 X{i % 50} Y{i % 7}\n" for i in range(1, 400)) + "M2\n")
FILES = {"--trace": "a.csv", "--bus-log": "a.log", "--report": "a.html", "--json": "a.json", "--junit": "a.xml"}
OPTIONS = [word for pair in FILES.items() for word in pair]


def listing():
    return sorted(os.listdir("."))


def fits(schema, value, place="summary"):
    """The part of JSON Schema that summary.schema.json uses."""
    names = {"object": dict, "array": list, "string": str, "boolean": bool, "integer": int, "null": type(None), "number": (int, float)}
    if "anyOf" in schema:
        return any(fits(option, value, place) is True for option in schema["anyOf"]) or f"{place}: none of anyOf"
    if "enum" in schema and value not in schema["enum"]:
        return f"{place}: not in enum"
    types = schema.get("type", [])
    types = [types] if isinstance(types, str) else types
    if types and not any(isinstance(value, names[n]) and (n == "boolean" or not isinstance(value, bool)) for n in types):
        return f"{place}: not {types}"
    if "pattern" in schema and isinstance(value, str) and not re.search(schema["pattern"], value):
        return f"{place}: not {schema['pattern']}"
    if "minimum" in schema and isinstance(value, (int, float)) and value < schema["minimum"]:
        return f"{place}: below minimum"
    if isinstance(value, list):
        return next((r for i, v in enumerate(value) if (r := fits(schema["items"], v, f"{place}[{i}]")) is not True), True)
    if isinstance(value, dict):
        if schema.get("additionalProperties") is False and set(value) - set(schema["properties"]):
            return f"{place}: unknown {set(value) - set(schema['properties'])}"
        if set(schema.get("required", [])) - set(value):
            return f"{place}: missing {set(schema['required']) - set(value)}"
        return next((r for k, v in value.items() if (r := fits(schema["properties"][k], v, f"{place}.{k}")) is not True), True)
    return True


def check_schema(summary):
    schema = t.load_json(os.path.join(t.SOURCE, "host", "results", "summary.schema.json"))
    found = fits(schema, summary)
    t.check(found is True, "the summary fits its schema", found)
    broken = dict(summary, outcome="maybe")
    t.check(fits(schema, broken) is not True, "the schema refuses a wrong outcome")
    broken = {k: v for k, v in summary.items() if k != "checks"}
    t.check(fits(schema, broken) is not True, "the schema refuses a missing field")
    try:
        import jsonschema
    except ImportError:
        return
    jsonschema.validate(summary, schema)


# A good run leaves exactly what was asked for.
before = listing()
status, out, err = t.run("run", PROGRAM, *OPTIONS)
t.check(status == 0, "the run is good", err)
t.check(listing() == sorted(before + list(FILES.values())), "exactly the files asked for", listing())
t.check(all(name in out for name in FILES.values()), "the summary names the files", out)
t.check("completed" in out and "19 of 19 held" in out, "the summary says how it went", out)

summary = t.load_json("a.json")
check_schema(summary)
t.check(summary["program"] == PROGRAM and abs(summary["program_time_s"] - summary["cycles"] * summary["cycle_time_s"]) < 1e-9, "its figures agree")
t.check(t.run("--version")[1] == f"takt {summary['version']}\n", "it says by which takt it was made", summary["version"])
t.check(all(c["held"] == (c["value"] <= c["limit"]) for c in summary["checks"]), "held is value <= limit")

suite = xml.parse("a.xml").getroot()
t.check(suite.get("tests") == str(len(summary["checks"])) and suite.get("failures") == "0", "JUnit counts the checks")
t.check([c.get("name") for c in suite] == [c["name"] for c in summary["checks"]], "one case a check")

with open("a.log") as file:
    frames = file.readlines()
t.check(len(frames) == summary["bus"]["frames"], "one line a frame", len(frames), summary["bus"])
t.check(all(re.fullmatch(r"\(\d{10}\.\d{6}\) can0 [0-9A-F]{3}#([0-9A-F]{2}){0,8}\n", f) for f in frames), "lines of candump -L")

with open("a.csv") as file:
    header, first = file.readline(), file.readline()
t.check(header == "cycle,time_s,block,line,feed_mm_min,override_percent,limiter," + ",".join(f"{k}_{a}_mm" for a in "XYZ" for k in ("cmd", "set", "act")) + ",spindle_rev\n", "columns of the trace", header)
t.check(re.fullmatch(r"0,0\.000000,1,2,[\d.]+,100\.000000,1\.000000(,-?\d+\.\d{9}){10}\n", first), "a row of the trace", first)

# Standard output can be one of the files; then the summary keeps out of its way.
status, out, err = t.run("run", PROGRAM, "--json", "-")
t.check(status == 0 and t.json.loads(out)["setpoint_digest"] == summary["setpoint_digest"], "JSON on standard output", err)
t.check("completed" in err, "the summary then goes to stderr", err)
status, out, _ = t.run("run", "-", "--json", "-", "--quiet", text=open(PROGRAM, "rb").read())
t.check(t.json.loads(out)["setpoint_digest"] == summary["setpoint_digest"], "a program from standard input moves the same")

# A failed check: status 1, and the files are there to look at.
status, out, _ = t.run("run", PROGRAM, "--set", "axis.X.following_error_max_mm=0.001", *OPTIONS)
failed = t.load_json("a.json")
t.check(status == 1, "a broken limit gives status 1", status)
t.check(failed["outcome"] == "faulted" and failed["fault"], "the controller faulted for it", failed["outcome"], failed["fault"])
t.check("FAILED      fault" in out and "lags" in out, "the summary says why", out)
t.check(xml.parse("a.xml").getroot().get("failures") != "0", "JUnit counts failures")
check_schema(failed)

# --until stops in time.
status, _, _ = t.run("run", PROGRAM, "--until", "0.25", "--json", "a.json", "--trace", "a.csv", "--quiet")
stopped = t.load_json("a.json")
t.check(status == 4 and stopped["exit_status"] == 4 and stopped["outcome"] == "stopped" and stopped["cycles"] == 250,
        "--until has a status of its own", status, stopped["cycles"])
check_schema(stopped)

# What cannot be written is said before anything moves, and what was there stays.
t.write("kept.json", "old")
before = listing()
status, _, err = t.run("run", PROGRAM, "--json", "kept.json", "--trace", "nowhere/a.csv", "--quiet")
t.check(status == 3 and "nowhere/a.csv" in err, "a folder that is not there", status, err)
t.check(open("kept.json").read() == "old" and listing() == before, "nothing has changed", listing())
status, _, err = t.run("run", PROGRAM, "--json", "a.json", "--trace", "a.json")
t.check(status == 2 and "same file" in err, "two outputs in one file", err)
text = open(PROGRAM).read()
status, _, err = t.run("run", PROGRAM, "--trace", PROGRAM)
t.check(status == 2 and open(PROGRAM).read() == text, "the program is not overwritten", err)
if os.path.exists("/dev/full"):
    status, _, err = t.run("run", PROGRAM, "--json", "/dev/full", "--trace", "full.csv", "--quiet")
    t.check(status == 3 and "full" in err and not os.path.exists("full.csv"), "a full disk", status, err)

for option in ("--trace", "--bus-log") if os.path.exists("/dev/full") else ():
    status, _, err = t.run("run", PROGRAM, option, "/dev/full", "--quiet")
    t.check(status == 3 and "/dev/full cannot be written: No space left" in err, "a file that cannot be written is named", option, status, err)

# A limit of the shell on the size of files is an error of the file, and leaves nothing.
before = listing()
done = subprocess.run(["bash", "-c", 'ulimit -f 100; "$@"', "bash", t.TAKT, "run", PROGRAM, "--trace", "large.csv", "--quiet"], capture_output=True, text=True)
t.check(done.returncode == 3 and "large.csv cannot be written: File too large" in done.stderr, "a file that is too large", done.returncode, done.stderr)
t.check(listing() == before, "nothing is left of it", listing())

# JUnit is UTF-8, and so is the name of a program, unless it is something else.
t.write("Schl\u00fcssel.ngc", text)
t.run("run", "Schl\u00fcssel.ngc", "--junit", "name.xml", "--quiet")
t.check("Schl\u00fcssel.ngc" in xml.parse("name.xml").getroot().get("name"), "JUnit has the name of the program")
with open(b"\xfcber.ngc", "w") as file:
    file.write(text)
subprocess.run([t.TAKT, "run", b"\xfcber.ngc", "--junit", "name.xml", "--quiet"], check=False)
t.check("?ber.ngc" in xml.parse("name.xml").getroot().get("name"), "what is no UTF-8 does not break it")

# Interrupted: the axes come to rest, and the files show the run up to there. The signal is sent when the files are open
# aside, seen by their names.
long_program = t.write("long.ngc", "G21 G90 F100\n" + "".join(f"G1 X{i % 2 * 400}\n" for i in range(1, 3000)))
before = listing()
process = subprocess.Popen([t.TAKT, "run", long_program, "--junit", "i.xml", "--json", "i.json"], stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
while process.poll() is None and not any(".part-" in name for name in listing()):
    pass
process.send_signal(signal.SIGINT)
t.check(process.wait() == 130, "interrupted: status 130", process.returncode)
t.check(listing() == sorted(before + ["i.json", "i.xml"]), "interrupted: the files are there, and nothing beside them", listing())
cut = t.load_json("i.json")
check_schema(cut)
t.check(cut["outcome"] == "interrupted" and cut["exit_status"] == 130, "the summary says so", cut["outcome"], cut["exit_status"])
t.check(all(c["held"] for c in cut["checks"]), "every check held on the way to rest", cut["checks"])
t.check(xml.parse("i.xml").getroot().get("skipped") == "1", "JUnit has no word on what did not come")

# Whatever drives an axis, it comes to rest on the path: the last setpoints are the same.
for options in ([], ["--drive-type", "X=step"], ["--drive-type", "step"]):
    process = subprocess.Popen([t.TAKT, "run", long_program, "--quiet", "--realtime", "--trace", "-", *options], stdout=subprocess.PIPE, text=True)
    for _ in range(300):
        process.stdout.readline()
    process.send_signal(signal.SIGTERM)
    rows = process.stdout.read().splitlines()
    t.check(process.wait() == 143, "SIGTERM: status 143", process.returncode, options)
    x = [float(row.split(",")[8]) for row in rows]
    v = [b - a for a, b in zip(x, x[1:])]
    a = [abs(q - p) / 1e-6 for p, q in zip(v, v[1:])]
    t.check(abs(v[-1]) < 1e-4 and max(a) <= 1000 * 1.0001, "the axis comes to rest within its limits", options, v[-3:], max(a))

# Parameters are saved only when asked for.
t.write("p.var", "5161\t0\n31\t2\n")
t.write("set.ngc", "#31 = 5\n#5163 = 4.5\n#100 = 1\nG0 X1\nM2\n")
t.run("run", "set.ngc", "--parameters", "p.var", "--quiet")
t.check(open("p.var").read() == "5161\t0\n31\t2\n", "parameters are not saved unasked")
status, _, err = t.run("run", "set.ngc", "--parameters", "p.var", "--save-parameters", "--quiet")
t.check(status == 0 and open("p.var").read() == "31\t5\n5161\t0\n5163\t4.5\n5220\t1\n", "saved: what the file lists, and what lasts", open("p.var").read(), err)
t.finish()
