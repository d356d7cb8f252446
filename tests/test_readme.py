"""What README.md and CONTRIBUTING.md say is so: examples run, commands exist, dependencies agree."""

import contextlib
import io
import re
import tomllib
from pathlib import Path

import pytest
import typer

from scenarios.cli import app
from scenarios.load import catalogue_names

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")
CONTRIBUTING = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
EXAMPLES = re.findall(r"```python\n(.*?)```\n\n```text\n(.*?)```", README, re.S)
COMMANDS = re.findall(r"sidestep ((?!-)[a-z]+)((?: +[^\s#`|]+)*)", README)


def lower_bounds(requirements):
    return dict(re.match(r"([A-Za-z0-9-]+)>=([0-9.]+)", text).groups() for text in requirements)


NUMBER = r"-?\d+(?:\.\d+)?"


def agree(printed, shown):
    """The same words, and every number within 5 % (the last digits differ from machine to machine)."""
    if re.sub(NUMBER, "#", printed) != re.sub(NUMBER, "#", shown):
        return False
    numbers = zip(re.findall(NUMBER, printed), re.findall(NUMBER, shown), strict=True)
    return all(float(one) == pytest.approx(float(other), rel=0.05) for one, other in numbers)


def test_every_python_block_has_its_output():
    assert len(EXAMPLES) == README.count("```python") >= 1


@pytest.mark.parametrize(("code", "output"), EXAMPLES)
def test_python_examples_print_what_is_shown(code, output):
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(code, "README.md", "exec"), {})
    assert agree(printed.getvalue(), output)


def test_outputs_agree_in_words_and_nearly_in_numbers():
    shown = "1 s: detour, 8.0 km ahead; 300 m\n[(10608, -889)]\n"
    assert agree("1 s: detour, 8.1 km ahead; 301 m\n[(10400, -900)]\n", shown)
    for other in ("8.0", "300", "10608", "-889"):
        assert not agree(shown.replace(other, "7"), shown)
    assert not agree(shown.replace("detour", "keep"), shown)
    assert not agree(shown, shown.replace("300", "@@"))


@pytest.mark.parametrize("file", [*ROOT.glob("*.md"), *ROOT.glob("docs/*.md")], ids=lambda file: file.name)
def test_no_figure_is_left_to_be_filled_in(file):
    assert "@@" not in file.read_text(encoding="utf-8")


@pytest.mark.parametrize(("command", "rest"), COMMANDS)
def test_commands_and_their_options_exist(command, rest):
    commands = typer.main.get_command(app).commands
    known = {option for parameter in commands[command].params for option in parameter.opts}
    words = rest.split()
    assert {word for word in words if word.startswith("-") and word[1:2].isalpha()} <= known
    assert {word for word in words if word.startswith("--")} <= known
    if command == "fly" and words and not words[0].startswith(("-", "my-")):
        assert words[0] in catalogue_names()


def test_install_without_mavsdk_names_everything_else():
    (line,) = re.findall(r"^pip install (\".*)$", README, re.M)
    bounds = lower_bounds(PROJECT["project"]["dependencies"])
    del bounds["mavsdk"]
    assert lower_bounds(re.findall(r'"([^"]+)"', line)) == bounds


def test_every_dependency_has_its_reason():
    rows = re.findall(r"^\| ([a-z0-9-]+) \| ([0-9.]+) \| .{12,} \| .{10,} \|$", CONTRIBUTING, re.M)
    project = PROJECT["project"]
    wanted = lower_bounds(project["dependencies"]) | lower_bounds(project["optional-dependencies"]["dev"])
    wanted |= lower_bounds(PROJECT["build-system"]["requires"])
    stated = dict(rows)
    assert {name: stated.get(name) for name in wanted} == wanted


@pytest.mark.parametrize("target", re.findall(r"make ([a-z]+)", README + CONTRIBUTING))
def test_make_targets_exist(target):
    assert re.search(rf"^{target}:", (ROOT / "Makefile").read_text(encoding="utf-8"), re.M)


@pytest.mark.parametrize("path", re.findall(r"\]\(([^)#:]+)\)|src=\"([^\"]+)\"", README))
def test_links_lead_somewhere(path):
    assert (ROOT / (path[0] or path[1])).exists()
