# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs a command on an X display of its own: private_display.py XVFB COMMAND...

xvfb-run -a guesses a display number and can meet another run on the way; here Xvfb chooses and tells.
"""
import os
import subprocess
import sys


def start(program, *options):
    """Starts Xvfb; returns the process and the name of its display."""
    reading, writing = os.pipe()
    server = subprocess.Popen([program, "-displayfd", str(writing), "-noreset", "-nolisten", "tcp", *options],
                              pass_fds=[writing],
                              stderr=subprocess.DEVNULL)
    os.close(writing)
    with os.fdopen(reading) as pipe:
        number = pipe.readline().strip()
    if not number:
        sys.exit("FAILED: Xvfb does not start")
    return server, f":{number}"


def stop(process):
    """Ends the server, or another program of a test; by force where it does not end by itself."""
    process.terminate()
    try:
        process.wait(timeout=15)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


if __name__ == "__main__":
    xvfb, display = start(sys.argv[1], "-screen", "0", "1280x1024x24")
    try:
        code = subprocess.call(sys.argv[2:], env=dict(os.environ, DISPLAY=display))
    finally:
        stop(xvfb)
    sys.exit(code)
