# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces that stay spread over the ranks, with 2 and 4 of them: test_spread.py MPIEXEC PVBATCH CASE...
[RANKS...]

Runs spread_script.py under mpirun. It ends with an error where something does not hold; a deadlock takes for ever.
"""
import os
import pathlib
import subprocess
import sys

SECONDS = 250  # for one case of one run on a busy machine


def main():
    mpiexec, pvbatch, *rest = sys.argv[1:]
    numbers = [argument for argument in rest if argument.isdigit()]
    cases = [argument for argument in rest if not argument.isdigit()]
    seconds = SECONDS * len(cases)
    script = pathlib.Path(__file__).with_name("spread_script.py")
    # Ranks that wait leave the processor to the others, of which there may be more than processors.
    environment = dict(os.environ, OMPI_MCA_mpi_yield_when_idle="1")
    for ranks in numbers or ("2", "4"):
        command = [mpiexec, "--oversubscribe", "-np", ranks, pvbatch, "--mpi", "--symmetric", str(script), *cases]
        try:
            done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=seconds,
                                  env=environment)
        except subprocess.TimeoutExpired as late:
            sys.exit(f"FAILED: {ranks} ranks did not end after {seconds} s\n{(late.stdout or b'').decode()}")
        if done.returncode != 0 or done.stdout.count("spread: fine") != int(ranks):
            sys.exit(f"FAILED: {ranks} ranks ended with {done.returncode}\n{done.stdout}")
        print(f"{' '.join(cases)}: fine with {ranks} ranks, {done.stdout.count(' quads')} meshes")


if __name__ == "__main__":
    main()
