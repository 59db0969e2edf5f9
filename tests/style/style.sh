# shellcheck shell=bash
# Sourced by the checks of this folder.
export LC_ALL=C

cd "${TAKT_SOURCE:?set by CTest to the root of the repository}" || exit

# Prints our C sources and headers, one a line.
c_files() {
    find firmware hal host tests -name '*.[ch]' | sort
}

# tool_or_skip NAME: sets TOOL to release 14 of a clang tool. Other releases format and judge differently.
tool_or_skip() {
    for TOOL in "$1-14" "$1"; do
        if command -v "$TOOL" >/dev/null && "$TOOL" --version | grep -q 'version 14\.'; then
            return
        fi
    done
    echo "$1 14 is not installed (Debian and Ubuntu: $1-14)"
    exit 77
}
