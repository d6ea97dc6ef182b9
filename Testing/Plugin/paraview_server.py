# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""A pvserver on a free port."""
import re
import socket
import subprocess
import threading


class Server:
    """Listens when it is made. What it says goes to the output, as errors above all belong to a test, until stop().

    command: pvserver, or what starts it on ranks.
    """

    def __init__(self, command, environment=None):
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self.port = probe.getsockname()[1]
        self.process = subprocess.Popen([*command, f"--server-port={self.port}"], stdout=subprocess.PIPE,
                                        stderr=subprocess.STDOUT, text=True, env=environment)
        said = []
        for line in self.process.stdout:
            said.append(line)
            if re.search("Accepting connection|Waiting for client", line):
                break
        else:
            raise SystemExit("FAILED: the server does not start\n" + "".join(said))
        self.is_heard = threading.Event()
        self.is_heard.set()
        threading.Thread(target=self.listen, daemon=True).start()

    def listen(self):
        for line in self.process.stdout:
            if self.is_heard.is_set():
                print("server:", line, end="", flush=True)

    def stop(self):
        """By force: a server may outlive its client, and its complaints of the end are no result of a test."""
        self.is_heard.clear()
        self.process.kill()
        self.process.wait(timeout=10)
