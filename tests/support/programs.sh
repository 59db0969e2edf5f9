# shellcheck shell=bash
# Sourced by test scripts that run real part programs.
#
# They are other people's work and not part of this repository: TAKT_PROGRAMS names their folder, else the folder
# shared/programs beside the repository is taken.

# Sets PROGRAMS to the folder, or ends the test as skipped.
programs_or_skip() {
    PROGRAMS=${TAKT_PROGRAMS:-$TAKT_SOURCE/../shared/programs}
    if [[ ! -d $PROGRAMS ]]; then
        echo "no real programs: TAKT_PROGRAMS is not set and ../shared/programs does not exist"
        exit 77
    fi
    PROGRAMS=$(cd "$PROGRAMS" && pwd)
}

# programs_need FILE...: ends the test as skipped if one of these programs is missing.
programs_need() {
    programs_or_skip
    local file
    for file in "$@"; do
        if [[ ! -e $PROGRAMS/$file ]]; then
            echo "no program $file in $PROGRAMS"
            exit 77
        fi
    done
}
