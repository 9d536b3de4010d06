"""Runs the cells of a notebook and compares what they give with the outputs in it: texts equal, pictures equal.

  notebook.py [--write] NOTEBOOK.ipynb     --write keeps the outputs instead"""

import ast
import base64
import contextlib
import io
import json
import os
import sys
import tempfile


def run_cell(source, names):
    """The outputs of a cell, as Jupyter keeps them: what it prints, and the value of its last expression."""
    body = ast.parse(source).body
    last = ast.Expression(body.pop().value) if body and isinstance(body[-1], ast.Expr) else None
    printed, value = io.StringIO(), None
    with contextlib.redirect_stdout(printed):
        exec(compile(ast.Module(body, []), "cell", "exec"), names)
        if last is not None:
            value = eval(compile(last, "cell", "eval"), names)
    outputs = []
    if printed.getvalue():
        outputs.append({"name": "stdout", "output_type": "stream", "text": printed.getvalue().splitlines(True)})
    if value is not None:
        data = {"text/plain": repr(value).splitlines(True)}
        if hasattr(value, "_repr_png_"):
            data["image/png"] = base64.b64encode(value._repr_png_()).decode()
        outputs.append({"data": data, "metadata": {}, "output_type": "execute_result"})
    return outputs


def main():
    write, path = "--write" in sys.argv, os.path.abspath(sys.argv[-1])
    with open(path, encoding="utf-8") as file:
        notebook = json.load(file)
    names, wrong = {}, 0
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for number, cell in enumerate(cell for cell in notebook["cells"] if cell["cell_type"] == "code"):
            outputs = run_cell("".join(cell["source"]), names)
            for output in outputs:
                if output["output_type"] == "execute_result":
                    output["execution_count"] = number + 1
            if not write and outputs != cell["outputs"]:
                wrong += 1
                print(f"cell {number + 1} gives {json.dumps(outputs)[:2000]}\nnot {json.dumps(cell['outputs'])[:2000]}")
            cell["outputs"], cell["execution_count"] = outputs, number + 1
        os.chdir("/")
    if write:
        with open(path, "w", encoding="utf-8") as file:
            json.dump(notebook, file, indent=1, sort_keys=True)
            file.write("\n")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
