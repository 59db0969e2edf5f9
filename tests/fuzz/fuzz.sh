# shellcheck shell=bash
# Sourced by fuzz_short and fuzz_long.

# An input that takes longer than this many seconds is a hang. Inputs are at most 4 KiB and take milliseconds.
FUZZ_HANG_S=60

# libFuzzer's own status for a finding is 77, which CTest takes for a skip.
FUZZ_STATUS=(-error_exitcode=1 -timeout_exitcode=1)

# fuzz PROGRAM FOLDER OPTION...: new inputs go into FOLDER, seeds are the goldens and the example programs.
fuzz() {
    local program=$1 corpus=$2
    shift 2
    mkdir -p "$corpus" "$corpus.seeds"
    cp "$TAKT_SOURCE"/tests/golden/*.ngc "$TAKT_SOURCE"/tests/programs/*.ngc "$corpus.seeds"
    "$program" -max_len=4096 -timeout=$FUZZ_HANG_S -rss_limit_mb=2048 -use_value_profile=1 -print_final_stats=1 \
        -dict="$TAKT_SOURCE/tests/fuzz/program.dict" "${FUZZ_STATUS[@]}" -artifact_prefix="$corpus." \
        "$@" "$corpus" "$corpus.seeds"
}
