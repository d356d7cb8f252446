"""The scripted PX4 as a board at the end of a serial line, in a process of its own.

`python -m offboard.hil.scripted_board FD AIRFRAME DECLINATION` speaks over an open file descriptor.
"""

from __future__ import annotations

import os
import sys

from offboard.hil.channels import load_airframe
from offboard.hil.scripted_px4 import ScriptedPx4


def main(arguments: list[str]) -> None:
    """Answer until the line is cut."""
    descriptor, airframe, declination = int(arguments[0]), arguments[1], float(arguments[2])
    board = ScriptedPx4(load_airframe(airframe), declination=declination, hardware=True)
    os.write(descriptor, board.hello())
    while data := os.read(descriptor, 65536):
        answer = board.feed(data)
        while answer:
            answer = answer[os.write(descriptor, answer) :]


if __name__ == "__main__":
    main(sys.argv[1:])
