# SPDX-License-Identifier: Apache-2.0
"""Speaks the Language Server Protocol (version 3.17) with a server on its standard input and output, as an editor."""
import json
import queue
import subprocess
import threading

PATIENCE = 60  # seconds


class LanguageServer:
    def __init__(self, command):
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        stderr=subprocess.DEVNULL)
        self.inbox = queue.Queue()
        threading.Thread(target=self._listen, daemon=True).start()
        self.last_id = 0
        self.diagnostics = {}
        self.request("initialize", {"processId": None, "rootUri": None, "capabilities": {
            "textDocument": {"hover": {"contentFormat": ["plaintext"]}}}})
        self.notify("initialized", {})
        # No catalogue from the network: only what the file's own first line names.
        self.notify("workspace/didChangeConfiguration", {"settings": {"yaml": {
            "validate": True, "hover": True, "completion": True, "schemaStore": {"enable": False}}}})

    def close(self):
        self.process.stdin.close()
        try:
            self.process.wait(timeout=PATIENCE)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self.process.stdout.close()

    def open(self, path, text=None):
        """The diagnostics of the file, or of `text` in its place."""
        uri = path.as_uri()
        self.diagnostics.pop(uri, None)
        self.notify("textDocument/didOpen", {"textDocument": {
            "uri": uri, "languageId": "yaml", "version": 1,
            "text": path.read_text(encoding="utf-8") if text is None else text}})
        while uri not in self.diagnostics:
            self._handle(self.inbox.get(timeout=PATIENCE))
        return self.diagnostics[uri]

    def ask(self, what, path, line, character):
        """`what` is hover or completion; line and character count from 0."""
        return self.request("textDocument/" + what, {
            "textDocument": {"uri": path.as_uri()}, "position": {"line": line, "character": character}})

    def request(self, method, params):
        self.last_id += 1
        own = self.last_id
        self._send({"id": own, "method": method, "params": params})
        while True:
            message = self.inbox.get(timeout=PATIENCE)
            if message.get("id") == own and "method" not in message:
                if "error" in message:
                    raise RuntimeError(message["error"])
                return message["result"]
            self._handle(message)

    def notify(self, method, params):
        self._send({"method": method, "params": params})

    def _send(self, message):
        body = json.dumps({"jsonrpc": "2.0", **message}).encode()
        self.process.stdin.write(b"Content-Length: %d\r\n\r\n" % len(body) + body)
        self.process.stdin.flush()

    def _handle(self, message):
        if message.get("method") == "textDocument/publishDiagnostics":
            self.diagnostics[message["params"]["uri"]] = message["params"]["diagnostics"]
        elif "id" in message and "method" in message:  # the server asks; an editor without opinions answers
            asked = message["params"].get("items", []) if isinstance(message.get("params"), dict) else []
            self._send({"id": message["id"], "result": [None] * len(asked) or None})

    def _listen(self):
        out = self.process.stdout
        while True:
            length = 0
            while (line := out.readline().strip()):
                if line.lower().startswith(b"content-length:"):
                    length = int(line.split(b":")[1])
            if not length:
                return
            self.inbox.put(json.loads(out.read(length)))
