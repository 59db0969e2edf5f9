#!/usr/bin/env python3
"""What a built takt consists of, as CycloneDX 1.5 (JSON): sbom.py TAKT VERSION [PLOTLY_VERSION]

Libraries are those the program is linked with, by the packages of this distribution.
"""
import json
import platform
import re
import subprocess
import sys

# By the package's name without the version of its interface: libwebsockets17, libwebsockets19t64.
LICENCES = {"libcjson": "MIT", "libinih": "BSD-3-Clause", "libmodbus": "LGPL-2.1-or-later", "libc": "LGPL-2.1-or-later", "libwebsockets": "MIT"}


def output(*command):
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout


def packages_of(takt):
    """Names of the packages that bring the libraries a program names itself."""
    named = re.findall(r"NEEDED\s+(\S+)", output("objdump", "-p", takt))
    paths = [path for name, path in re.findall(r"(\S+) => (\S+)", output("ldd", takt)) if name in named]
    found = [output("dpkg", "-S", path.replace("/lib/", "/usr/lib/", 1)) or output("dpkg", "-S", path) for path in paths]
    return sorted({line.split(":")[0] for line in found if line})


def component(name, version, licence, purl):
    made = {"type": "library", "name": name, "version": version, "purl": purl}
    if licence:
        made["licenses"] = [{"license": {"id": licence}}]
    return made


def main():
    takt, version = sys.argv[1:3]
    plotly = sys.argv[3] if len(sys.argv) > 3 else ""
    components = []
    distribution = platform.freedesktop_os_release()["ID"]
    for package in packages_of(takt):
        installed = output("dpkg-query", "-W", "-f", "${Version}", package)
        components.append(component(package, installed, LICENCES.get(re.sub(r"\d+(t64)?$", "", package)),
                                    f"pkg:deb/{distribution}/{package}@{installed}"))
    if plotly:
        components.append(component("plotly.js-gl3d-dist-min", plotly, "MIT", f"pkg:npm/plotly.js-gl3d-dist-min@{plotly}"))
    root = component("takt", version, "MIT", f"pkg:generic/takt@{version}")
    print(json.dumps({"bomFormat": "CycloneDX", "specVersion": "1.5", "version": 1,
                      "metadata": {"component": {**root, "type": "application"}}, "components": components}, indent=2))


main()
