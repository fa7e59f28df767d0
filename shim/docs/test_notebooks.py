# SPDX-License-Identifier: MIT
"""The notebooks run, and their outputs are committed, small. RLVC_WRITE_NOTEBOOKS=1 writes what they print now."""

import itertools
import os
import pathlib

import nbformat
import pytest
from nbclient import NotebookClient

NOTEBOOKS = sorted((pathlib.Path(__file__).resolve().parent / "notebooks").glob("*.ipynb"))
BYTES = 64 * 1024


def kinds(notebook):
    """What kinds of output each cell has, one after another. What a cell prints may come in several pieces."""
    outputs = [[output["output_type"] for output in cell.get("outputs", [])] for cell in notebook.cells]
    return [[kind for kind, _ in itertools.groupby(each)] for each in outputs]


@pytest.mark.parametrize("file", NOTEBOOKS, ids=lambda file: file.stem)
def test_notebook(file, tmp_path):
    committed = nbformat.read(file, 4)
    notebook = nbformat.read(file, 4)
    NotebookClient(notebook, timeout=300, kernel_name="python3", resources={"metadata": {"path": tmp_path}}).execute()
    if os.environ.get("RLVC_WRITE_NOTEBOOKS"):
        notebook.metadata = committed.metadata
        for cell in notebook.cells:
            cell.metadata.pop("execution", None)
        nbformat.write(notebook, file)
    else:
        assert kinds(notebook) == kinds(committed), "run it again with RLVC_WRITE_NOTEBOOKS=1"
    assert file.stat().st_size <= BYTES
