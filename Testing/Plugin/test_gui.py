# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""ParaView's window under Xvfb: the plugin loads by itself, the filter shows in panel and view, a screenshot is kept.

  test_gui.py XVFB PARAVIEW
"""
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import time
import zlib

import private_display

ARTIFACTS = pathlib.Path(os.environ["QUADRILLE_ARTIFACTS"])
WIDTH, HEIGHT = 1152, 762  # ParaView's own size where there is no window manager


def read_xwd(path):
    """Rows of (r, g, b) bytes of the frame buffer that Xvfb keeps in a file: XWD, 32 bits a pixel."""
    data = path.read_bytes()
    header = struct.unpack(">25I", data[:100])
    size, width, height, bits, row, colours = header[0], header[4], header[5], header[11], header[12], header[19]
    little = header[7] == 0
    assert bits == 32, bits
    start = size + 12 * colours
    rows = []
    for y in range(height):
        line = data[start + y * row:start + y * row + 4 * width]
        r, g, b = (line[2::4], line[1::4], line[0::4]) if little else (line[1::4], line[2::4], line[3::4])
        rgb = bytearray(3 * width)
        rgb[0::3], rgb[1::3], rgb[2::3] = r, g, b
        rows.append(bytes(rgb))
    return rows


def write_png(path, rows):
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    header = struct.pack(">IIBBBBB", len(rows[0]) // 3, len(rows), 8, 2, 0, 0, 0)
    body = zlib.compress(b"".join(b"\0" + row for row in rows), 6)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", body) + chunk(b"IEND", b""))


def colours(rows):
    return len({row[3 * x:3 * x + 3] for row in rows[::3] for x in range(0, len(row) // 3, 3)})


def wait_for(paths, process, seconds):
    end = time.time() + seconds
    while time.time() < end and process.poll() is None:
        if any(p.exists() for p in paths):
            return True
        time.sleep(0.5)
    return any(p.exists() for p in paths)


def main():
    xvfb, paraview = sys.argv[1:3]
    failure = None
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        server, display = private_display.start(xvfb, "-screen", "0", f"{WIDTH}x{HEIGHT}x24", "-fbdir", str(folder))
        ready, failed, log = folder / "ready", folder / "failed", folder / "log"
        environment = dict(os.environ, DISPLAY=display, QUADRILLE_READY=str(ready), QUADRILLE_FAILED=str(failed),
                           HOME=str(folder), XDG_CONFIG_HOME=str(folder), XDG_RUNTIME_DIR=str(folder),
                           PV_PLUGIN_PATH=os.path.dirname(os.environ["QUADRILLE_PLUGIN"]))
        script = pathlib.Path(__file__).with_name("gui_script.py")
        with open(log, "w") as output:
            window = subprocess.Popen([paraview, "--dr", f"--script={script}"], env=environment, stdout=output,
                                      stderr=subprocess.STDOUT)
        try:
            if not wait_for([ready, failed], window, 200):
                failure = "the window's script did not come to its end"
            elif failed.exists():
                failure = failed.read_text()
            time.sleep(2)  # the window paints its panels after the script
            rows = read_xwd(folder / "Xvfb_screen0")
            write_png(ARTIFACTS / "gui.png", rows)
            if window.poll() is not None:
                failure = failure or f"the window ended by itself with {window.returncode}"
            shades = colours(rows)
            print(f"gui: {shades} colours in the screenshot {ARTIFACTS / 'gui.png'}")
            # An empty screen has one colour; panels alone have some dozens; shaded quads hundreds.
            if shades < 200:
                failure = failure or f"the screenshot has only {shades} colours"
        finally:
            window.terminate()
            try:
                window.wait(timeout=15)
            except subprocess.TimeoutExpired:
                window.kill()
                window.wait()
            private_display.stop(server)
        print(log.read_text())
    if failure:
        sys.exit("FAILED: " + failure)
    print("gui: fine")


if __name__ == "__main__":
    main()
