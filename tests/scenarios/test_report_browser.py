"""The report in a real browser: no error, and what is drawn is what the files hold."""

import json
import re
import shutil
import subprocess

import pytest

from scenarios.report import write_report
from tests.scenarios.report_run import write_run

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
OBSTACLES = tuple((3_000.0 + 5_000.0 * i, 200.0 + 300.0 * i, 400.0 + 100.0 * i) for i in range(9))
# Counts what plotly holds after drawing, and reports whatever the page has to complain of.
PROBE = """
<script>
(function () {
  const element = document.getElementById("top-view");
  const trace = (role) => element.data.find((t) => t.meta.role === role);
  const rings = trace("spheres").x.filter((x) => x === null).length + 1;
  const points = (role) => element.querySelectorAll(".scatterlayer .trace").length && trace(role).x.length;
  const drawn = { spheres: rings, waypoints: points("waypoints"), decisions: points("decisions"),
    marks: element.querySelectorAll(".points path").length,
    wide: document.documentElement.scrollWidth - document.documentElement.clientWidth,
    rows: document.querySelectorAll("#decision-table tbody tr").length,
    plots: document.querySelectorAll(".plot").length,
    svgs: document.querySelectorAll(".plot .main-svg").length };
  const out = document.createElement("script");
  out.type = "application/json"; out.id = "drawn"; out.textContent = JSON.stringify(drawn);
  document.body.appendChild(out);
})();
</script>
</body>
"""


@pytest.fixture(scope="module")
def run_directory(tmp_path_factory):
    directory = write_run(tmp_path_factory.mktemp("run"), obstacles=OBSTACLES, traffic=True)
    report = write_report(directory)
    probed = report.read_text(encoding="utf-8").replace("</body>", PROBE)
    (directory / "probed.html").write_text(probed, encoding="utf-8")
    return directory


def open_page(file, profile, width):
    """The page's document and everything the browser said while it ran."""
    switches = (
        "--headless=new --no-sandbox --disable-gpu --disable-background-networking --no-first-run "
        "--disable-sync --disable-component-update --disable-dev-shm-usage --enable-logging=stderr "
        f"--virtual-time-budget=10000 --window-size={width},2000 --dump-dom"
    )
    command = [BROWSER, *switches.split(), f"--user-data-dir={profile}", file.as_uri()]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)
    return done.stdout, re.findall(r".*:CONSOLE[:(].*", done.stderr)


@pytest.mark.browser
@pytest.mark.skipif(BROWSER is None, reason="no Chromium or Chrome is installed")
@pytest.mark.parametrize("width", [1280, 500])
def test_browser_draws_what_the_files_hold(run_directory, tmp_path, width):
    page, console = open_page(run_directory / "probed.html", tmp_path, width)
    drawn = json.loads(re.search(r'id="drawn">(.*?)</script>', page)[1])
    decisions = (run_directory / "decisions.jsonl").read_text().splitlines()
    obstacles = (run_directory / "obstacles.csv").read_text().splitlines()[1:]
    moving = {line.split(",")[1] for line in (run_directory / "traffic.csv").read_text().splitlines()[1:]}
    assert console == []
    assert drawn["spheres"] == len(obstacles) + len(moving)
    assert drawn["decisions"] == drawn["rows"] == len(decisions)
    assert drawn["waypoints"] == sum(len(json.loads(line)["waypoints"]) for line in decisions)
    assert drawn["marks"] >= drawn["decisions"] + drawn["waypoints"] + drawn["spheres"]
    assert drawn["svgs"] >= drawn["plots"] >= 4
    assert drawn["wide"] <= 0, "the page must not scroll sideways"


@pytest.mark.browser
@pytest.mark.skipif(BROWSER is None, reason="no Chromium or Chrome is installed")
def test_console_errors_would_be_seen(tmp_path):
    broken = tmp_path / "broken.html"
    broken.write_text("<!doctype html><script>nowhere();</script>", encoding="utf-8")
    _, console = open_page(broken, tmp_path / "profile", 1280)
    assert any("nowhere" in line for line in console)
