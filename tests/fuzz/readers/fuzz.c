/*
 * libFuzzer on the reader that TAKT_FUZZ_READER names; without, all names. One program for all:
 * tests/campaign keeps a corpus of each.
 */
#include "readers.h"

int LLVMFuzzerInitialize(int *argc, char ***argv);

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
    (void)argc;
    (void)argv;
    if (!readers_choose(getenv("TAKT_FUZZ_READER")))
        exit(getenv("TAKT_FUZZ_READER") != NULL);
    return 0;
}
