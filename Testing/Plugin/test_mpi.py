# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""The same quads with 1, 2 and 4 ranks, without deadlock: test_mpi.py MPIEXEC PVBATCH CASE...

Runs mpi_script.py under mpirun with each number of ranks. Each rank writes a line for each block that it holds and for
what the filter tells. A block may lie on any rank, but on one only; what the filter tells must be the same on all
ranks; and all must be the same for each number of ranks.
"""
import os
import pathlib
import subprocess
import sys
import tempfile

RANKS = (1, 2, 4)
SECONDS = 100  # for one case of one run on a busy machine; a deadlock takes for ever


def run(mpiexec, pvbatch, ranks, cases):
    """The lines that the ranks wrote, and everything that was printed."""
    script = pathlib.Path(__file__).with_name("mpi_script.py")
    command = [mpiexec, "--oversubscribe", "-np", str(ranks), pvbatch, "--mpi", "--symmetric", str(script), *cases]
    with tempfile.TemporaryDirectory() as folder:
        # Ranks that wait leave the processor to the others, of which there may be more than processors.
        environment = dict(os.environ, QUADRILLE_MPI_FACTS=folder, OMPI_MCA_mpi_yield_when_idle="1")
        seconds = SECONDS * len(cases)
        try:
            done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                  timeout=seconds, env=environment)
        except subprocess.TimeoutExpired as late:
            sys.exit(f"FAILED: {ranks} ranks did not end after {seconds} s\n{(late.stdout or b'').decode()}")
        if done.returncode != 0:
            sys.exit(f"FAILED: {ranks} ranks ended with {done.returncode}\n{done.stdout}")
        lines = [line for facts in pathlib.Path(folder).iterdir() for line in facts.read_text().splitlines()]
        return lines, done.stdout


def main():
    mpiexec, pvbatch, *cases = sys.argv[1:]
    reference = None
    for ranks in RANKS:
        lines, output = run(mpiexec, pvbatch, ranks, cases)
        blocks = sorted(line for line in lines if line.startswith("BLOCK "))
        told = [line for line in lines if line.startswith("TOLD ")]
        errors = [line for line in output.splitlines() if "ERR|" in line]
        if not told or len(told) != ranks * len(set(told)):
            sys.exit(f"FAILED: {ranks} ranks do not tell the same\n{output}")
        got = (blocks, sorted(set(told)), len(errors))
        print(f"{ranks} ranks:", *blocks, *sorted(set(told)), f"{len(errors)} errors", sep="\n  ")
        if reference is None:
            reference = got
        elif got != reference:
            sys.exit(f"FAILED: {ranks} ranks give other results than {RANKS[0]}\n{output}")
    print("mpi: fine")


if __name__ == "__main__":
    main()
