#!/usr/bin/env python3
"""pack_texts.py error.h OUTPUT.c: the texts of errors in half their size, for images.

The pair of bytes that is most frequent in all texts gets a byte of its own, and so again (Gage: A new algorithm for data
compression, C Users Journal 12, 1994). Same texts, same output."""

import collections
import re
import sys

PLAIN = 128
DEPTH = 16


def read_texts(path):
    """Of TAKT_ERRORS, in its order."""
    source = open(path, encoding="utf-8").read()
    table = source[source.index("#define TAKT_ERRORS(X)"):]
    table = table[:table.index("\n\n")].replace("\\\n", " ")
    literal = r'"((?:[^"\\]|\\.)*)"'
    rows = re.findall(rf"X\(\w+,((?:\s*{literal})+)\s*\)", table)
    texts = ["".join(re.findall(literal, row[0])) for row in rows]
    if len(texts) != len(re.findall(r"\bX\(\w+,", table)) or any("\\" in text for text in texts):
        sys.exit(f"{path}: a row of TAKT_ERRORS is not understood")
    return [list(text.encode("ascii")) for text in texts]


def replace(text, pair, byte):
    result, i = [], 0
    while i < len(text):
        if tuple(text[i:i + 2]) == pair:
            result.append(byte)
            i += 1
        else:
            result.append(text[i])
        i += 1
    return result


def pack(texts):
    """Packed texts and the pairs. A pair must occur more often than it costs."""
    pairs, depth = [], collections.defaultdict(int)
    while len(pairs) < 256 - PLAIN:
        counts = collections.Counter(pair for text in texts for pair in zip(text, text[1:])
                                     if max(depth[pair[0]], depth[pair[1]]) + 1 < DEPTH)
        if not counts:
            break
        pair, times = min(counts.items(), key=lambda item: (-item[1], item[0]))
        if times <= 2:
            break
        byte = PLAIN + len(pairs)
        depth[byte] = 1 + max(depth[pair[0]], depth[pair[1]])
        texts = [replace(text, pair, byte) for text in texts]
        pairs.append(pair)
    return texts, pairs


def main():
    texts, pairs = pack(read_texts(sys.argv[1]))
    with open(sys.argv[2], "w", encoding="ascii") as out:
        out.write('/* Made by hal/port/pack_texts.py. */\n#include "base/error_text.h"\n\n')
        out.write("const uint8_t takt_error_text_pairs[][2] = {\n")
        out.writelines(f"    {{{first}, {second}}},\n" for first, second in pairs or [(0, 0)])
        out.write("};\n\nstatic const uint8_t texts[] = {\n")
        out.writelines("    " + "".join(f"{byte}, " for byte in text) + "0,\n" for text in texts)
        out.write("};\n\nconst uint8_t *takt_error_text_find(unsigned index)\n{\n    const uint8_t *text = texts;\n"
                  "    for (; index > 0; text++)\n        index -= *text == 0;\n    return text;\n}\n")


main()
