#!/usr/bin/python3
"""A foreign client of the language server protocol, that of pygls, works with `takt lsp` as it is."""

import asyncio
import os

import packages

packages.require("pygls", "lsprotocol")

# pylint: disable=wrong-import-position
from lsprotocol import types
from pygls.lsp.client import LanguageClient

PART = "G21 G90 F600 S1000 M3\nG0 Z5\nO100 call [20]\nG1 X50 M31\nM2\nO100 sub\nG1 Y#1\nO100 endsub\n"
MENDED = PART.replace(" M31", "")
URI = "file://" + os.path.abspath("part.ngc")
PATIENCE_S = 60


def check(condition, claim, *details):
    if not condition:
        raise AssertionError(claim, *details)


async def work():
    client = LanguageClient("editor", "1")
    published = asyncio.Queue()
    client.feature(types.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)(lambda params: published.put_nowait(params.diagnostics))
    await client.start_io(os.environ["TAKT"], "lsp")
    said = await client.initialize_async(types.InitializeParams(capabilities=types.ClientCapabilities()))
    check(said.server_info.name == "takt" and said.capabilities.position_encoding == "utf-16", "initialize", said)
    client.initialized(types.InitializedParams())

    client.text_document_did_open(types.DidOpenTextDocumentParams(types.TextDocumentItem(URI, "gcode", 1, PART)))
    found = await published.get()
    check([(d.severity, d.range.start, d.range.end) for d in found] ==
          [(types.DiagnosticSeverity.Error, types.Position(3, 7), types.Position(3, 10))], "diagnostics", found)
    client.text_document_did_change(types.DidChangeTextDocumentParams(
        types.VersionedTextDocumentIdentifier(2, URI), [types.TextDocumentContentChangeWholeDocument(MENDED)]))
    found = await published.get()
    check(len(found) == 0, "mended", found)

    document = types.TextDocumentIdentifier(URI)
    hover = await client.text_document_hover_async(types.HoverParams(document, types.Position(3, 0)))
    check("**G1**" in hover.contents.value and "G1 G17 G21" in hover.contents.value, "hover", hover)
    where = await client.text_document_definition_async(types.DefinitionParams(document, types.Position(2, 3)))
    check(where.uri == URI and where.range.start.line == 5, "definition", where)

    client.text_document_did_close(types.DidCloseTextDocumentParams(document))
    check(len(await published.get()) == 0, "closed")
    await client.shutdown_async(None)
    client.exit(None)
    await client.stop()


asyncio.run(asyncio.wait_for(work(), PATIENCE_S))
