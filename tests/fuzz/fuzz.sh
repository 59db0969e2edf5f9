# shellcheck shell=bash
# Sourced by fuzz_short and fuzz_long.

# An input that takes longer than this many seconds is a hang. Inputs are at most 4 KiB and take milliseconds.
FUZZ_HANG_S=60

# libFuzzer's own status for a finding is 77, which CTest takes for a skip.
FUZZ_STATUS=(-error_exitcode=1 -timeout_exitcode=1)

# fuzz_program reads part programs: the goldens and the example programs are its seeds.
fuzz_seeds_program() {
    cp "$TAKT_SOURCE"/tests/golden/*.ngc "$TAKT_SOURCE"/tests/programs/*.ngc "$1"
    FUZZ_OPTIONS=(-dict="$TAKT_SOURCE/tests/fuzz/program.dict")
}

# fuzz_modbus reads what clients send: one request of each function, made right and length first (mode 2), and the
# longest reads of each row of texts and bytes.
fuzz_seeds_modbus() {
    printf '\x02\x05\x01\x00\x00\x00\x0d\x05\x03\x00\x00\x00\x0a\x05\x04\x00\x3c\x00\x24' >"$1/reads"
    printf '\x02\x05\x05\x00\x01\xff\x00\x05\x06\x00\x00\x03\x20\x07\x0f\x00\x03\x00\x02\x01\x03' >"$1/writes"
    printf '\x03\x0a\x10\x00\x06\x00\x02\x04\x00\x00\x03\xe8\x0c\x17\x00\x00\x00\x02\x00\x01\x00\x01\x02\x01\xf4' >"$1/pairs"
    printf '\x02\x10\x10\x00\x32\x00\x05\x0a\x00\x00\x00\x03\x00\x00\x00\x00\x00\x01' >"$1/upload"
    printf '\x00\x00\x01\x00\x00\x00\x06\x01\x03\x00\x00\x00\x01' >"$1/tcp"
    printf '\x02\x05\x03\x00\x68\x00\x78\x05\x03\x01\x2c\x00\x40\x05\x04\x00\xc8\x00\x64' >"$1/texts"
    printf '\x01\x01\x03\x00\x00\x00\x01\x84\x0a' >"$1/line"
    FUZZ_OPTIONS=(-len_control=0)
}

# fuzz PROGRAM FOLDER OPTION...: new inputs go into FOLDER, seeds beside it.
fuzz() {
    local program=$1 corpus=$2 name
    shift 2
    name=$(basename "$program")
    mkdir -p "$corpus" "$corpus.seeds"
    "fuzz_seeds_${name#fuzz_}" "$corpus.seeds"
    "$program" -max_len=4096 -timeout=$FUZZ_HANG_S -rss_limit_mb=2048 -use_value_profile=1 -print_final_stats=1 \
        "${FUZZ_OPTIONS[@]}" "${FUZZ_STATUS[@]}" -artifact_prefix="$corpus." "$@" "$corpus" "$corpus.seeds"
}
