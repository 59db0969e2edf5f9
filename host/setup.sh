# shellcheck shell=bash
# Sourced by host/run and tests/run: finds out what is missing, installs it, configures and builds.
#
# Messages go to standard error. What cannot be had ends the script with status 3, as `takt` itself does.

TAKT_ROOT=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.." && pwd -P)
TAKT_BUILD=$TAKT_ROOT/build
SETUP_QUIET=${SETUP_QUIET:-}
SETUP_APT_INSTALL=(apt-get install --yes --no-install-recommends)

# Packages found missing so far.
setup_missing=()
# Not empty: something was installed, so what CMake found out before may no longer hold.
setup_stale=

setup_say() {
    [[ $SETUP_QUIET ]] || printf 'takt: %s\n' "$*" >&2
}

setup_fail() {
    printf 'takt: %s\n' "$*" >&2
    exit 3
}

# setup_need PACKAGE COMMAND...: PACKAGE is missing if COMMAND fails.
setup_need() {
    local package=$1
    shift
    "$@" >/dev/null 2>&1 || setup_missing+=("$package")
}

setup_has_builder() {
    command -v ninja || command -v make
}

setup_has_c_library() {
    echo '#include <stdio.h>' | cc -E -
}

# What the takt command is built with. Certificates: the report's plotting library is downloaded once.
setup_need_for_host() {
    setup_need cmake command -v cmake
    setup_need ninja-build setup_has_builder
    setup_need gcc command -v cc
    setup_need libc6-dev setup_has_c_library
    setup_need pkg-config command -v pkg-config
    setup_need libinih-dev pkg-config --exists inih
    setup_need libcjson-dev pkg-config --exists libcjson
    setup_need libmodbus-dev pkg-config --exists libmodbus
    setup_need libwebsockets-dev pkg-config --exists libwebsockets
    setup_need ca-certificates test -e /etc/ssl/certs/ca-certificates.crt
}

# What an image for a microcontroller is built with, and QEMU, which runs it.
setup_need_for_target() {
    setup_need gcc-arm-none-eabi command -v arm-none-eabi-gcc
    setup_need picolibc-arm-none-eabi arm-none-eabi-gcc --specs=picolibc.specs -E -x c /dev/null
    setup_need python3 command -v python3
    setup_need qemu-system-arm command -v qemu-system-arm
}

setup_need_for_riscv() {
    setup_need gcc-riscv64-unknown-elf command -v riscv64-unknown-elf-gcc
    setup_need picolibc-riscv64-unknown-elf riscv64-unknown-elf-gcc --specs=picolibc.specs -E -x c /dev/null
    setup_need python3 command -v python3
    setup_need qemu-system-misc command -v qemu-system-riscv64
}

# setup_as_root COMMAND...
setup_as_root() {
    if [[ $(id -u) == 0 ]]; then
        DEBIAN_FRONTEND=noninteractive "$@"
    else
        sudo -n env DEBIAN_FRONTEND=noninteractive "$@"
    fi
}

setup_can_install() {
    command -v apt-get >/dev/null && { [[ $(id -u) == 0 ]] || sudo -n true 2>/dev/null; }
}

# setup_is_listed PACKAGE...: apt's package lists know all of them.
setup_is_listed() {
    apt-cache show "$@" >/dev/null 2>&1
}

# Prints the one line that installs the given packages.
setup_apt_line() {
    setup_is_listed "$@" || printf 'apt-get update && '
    printf '%s %s\n' "${SETUP_APT_INSTALL[*]}" "$*"
}

setup_apt_get() {
    # Lists that are there may still be out of date: on failure the update is made up for.
    setup_is_listed "$@" && setup_as_root "${SETUP_APT_INSTALL[@]}" "$@" && return
    setup_as_root apt-get update && setup_as_root "${SETUP_APT_INSTALL[@]}" "$@"
}

# Installs what is missing; ends the script if that cannot be done.
setup_install() {
    ((${#setup_missing[@]})) || return 0
    if ! command -v apt-get >/dev/null; then
        setup_fail "missing, and there is no apt-get to install it (names are Debian's): ${setup_missing[*]}"
    fi
    if ! setup_can_install; then
        printf 'takt: some packages are missing, and neither root nor sudo is at hand; please run as root:\n' >&2
        setup_apt_line "${setup_missing[@]}" >&2
        exit 3
    fi
    printf 'takt: installing %s\n' "${setup_missing[*]}" >&2
    setup_logged install setup_apt_get "${setup_missing[@]}"
    setup_stale=yes
    setup_missing=()
}

# setup_install_optional PACKAGE...: installs those that are missing and that the distribution has.
setup_install_optional() {
    local package
    local -a wanted=()
    command -v apt-get >/dev/null || return 0
    for package in "$@"; do
        dpkg -s "$package" >/dev/null 2>&1 || wanted+=("$package")
    done
    ((${#wanted[@]})) || return 0
    if ! setup_can_install; then
        setup_say "not installed, for want of root or sudo: ${wanted[*]}"
        return 0
    fi
    setup_is_listed "${wanted[@]}" || setup_as_root apt-get update >/dev/null 2>&1 || true
    for package in "${wanted[@]}"; do
        if ! setup_is_listed "$package"; then
            setup_say "this distribution has no package $package"
        elif setup_say "installing $package" && ! setup_apt_get "$package" >"$TAKT_BUILD/install.log" 2>&1; then
            setup_say "$package could not be installed; see $TAKT_BUILD/install.log"
        else
            setup_stale=yes
        fi
    done
}

# setup_logged NAME COMMAND...: COMMAND writes to build/NAME.log, whose end is shown if it fails.
setup_logged() {
    local log=$TAKT_BUILD/$1.log
    shift
    if ! "$@" >"$log" 2>&1; then
        tail -n 60 "$log" >&2
        setup_fail "failed: $* (log: $log)"
    fi
}

# Only one process at a time installs, configures and builds.
setup_lock() {
    if ! mkdir -p "$TAKT_BUILD" 2>/dev/null || ! { exec 9>"$TAKT_BUILD/.lock"; } 2>/dev/null; then
        setup_fail "cannot write to $TAKT_BUILD"
    fi
    if ! flock --nonblock 9; then
        setup_say "waiting for another build in $TAKT_BUILD"
        flock 9
    fi
}

setup_unlock() {
    exec 9>&-
}

# setup_cached FOLDER NAME: the value of a variable in CMake's cache, "" if there is none.
setup_cached() {
    sed -n "s|^$2:[A-Z]*=||p" "$1/CMakeCache.txt" 2>/dev/null || true
}

# setup_configure PRESET TESTS: TESTS is ON, or OFF if the takt command alone is enough.
setup_configure() {
    local folder=$TAKT_BUILD/$1 tests=$2 stale=$setup_stale home
    local -x CMAKE_GENERATOR=${CMAKE_GENERATOR:-}

    home=$(setup_cached "$folder" CMAKE_HOME_DIRECTORY)
    if [[ $home && $(readlink -f "$home") != "$TAKT_ROOT" ]]; then
        rm -rf "$folder" # the repository has moved
    fi
    if [[ -e $folder/build.ninja || -e $folder/Makefile ]]; then
        # Tests once configured stay so.
        if [[ $(setup_cached "$folder" TAKT_TESTS) == ON ]]; then
            tests=ON
        elif [[ $tests == ON ]]; then
            stale=yes
        fi
        [[ $stale ]] || return 0
    fi
    if [[ -z $(setup_cached "$folder" CMAKE_GENERATOR) && -z $CMAKE_GENERATOR ]] && command -v ninja >/dev/null; then
        CMAKE_GENERATOR=Ninja
    fi
    [[ $CMAKE_GENERATOR ]] || unset CMAKE_GENERATOR
    setup_say "configuring and building in $folder"
    (
        cd "$TAKT_ROOT"
        setup_logged "configure-$1" cmake --no-warn-unused-cli --preset "$1" -DTAKT_TESTS="$tests"
    ) || exit
    [[ $SETUP_QUIET ]] || sed -n '/^CMake Warning/,/^$/p' "$TAKT_BUILD/configure-$1.log" >&2
}

# setup_build PRESET TESTS [TARGET]: configures if need be, and builds.
setup_build() {
    setup_configure "$1" "$2"
    setup_logged "build-$1" cmake --build "$TAKT_BUILD/$1" --parallel "$(nproc)" ${3:+--target "$3"}
}
