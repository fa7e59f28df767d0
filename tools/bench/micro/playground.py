#!/usr/bin/env python3
#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Measures the playground in Chromium: how large the module is, how long Sutton's maze takes to learn,
and how many frames a second a maze of 30 x 30 cells gets while it is learnt as fast as can be. Learning
may take 12 ms of a frame; on a busy machine the processor time of a frame says more than their number.

    playground.py FOLDER

FOLDER is a built playground (examples/playground/build.py). Needs the Python package playwright and
/usr/bin/chromium."""

import gzip
import pathlib
import sys

from playwright.sync_api import sync_playwright

LEARN = """page.then(({lab}) => {
    const start = performance.now();
    while (lab.view.interactions < lab.view.schedule || lab.view.learning) lab.tick(1000);
    return performance.now() - start;
})"""
SAMPLE = """page.then(({maze}) =>
    ({frames: maze.runner.frames, ms: performance.now(), classes: maze.lab.view.classes}))"""


def sample(page, devtools):
    """Frames so far, the time in ms, and the processor time of the page's thread in s."""
    metrics = devtools.send("Performance.getMetrics")["metrics"]
    busy = next(each["value"] for each in metrics if each["name"] == "TaskDuration")
    return {**page.evaluate(SAMPLE), "busy": busy}


def main():
    folder = pathlib.Path(sys.argv[1]).resolve()
    module = (folder / "rlvc.wasm").read_bytes()
    print(f"module: {len(module):,} bytes, {len(gzip.compress(module, 9)):,} with gzip")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path="/usr/bin/chromium", args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": 1280, "height": 900})
        page.goto((folder / "index.html").as_uri())
        page.wait_for_selector("body[data-ready]")
        print(f"Sutton's maze, 2,500 interactions: {page.evaluate(LEARN):.0f} ms")
        page.select_option("#preset", "Nine rooms, 30 by 30")
        page.evaluate("page.then(({maze}) => { maze.finished = true; maze.setSpeed(4); })")
        page.click("#run")
        devtools = page.context.new_cdp_session(page)
        devtools.send("Performance.enable", {"timeDomain": "threadTicks"})
        first = sample(page, devtools)
        for _ in range(4):
            page.wait_for_timeout(3000)
            last = sample(page, devtools)
            frames, passed = last["frames"] - first["frames"], last["ms"] - first["ms"]
            busy = 1000 * (last["busy"] - first["busy"]) / frames
            print(f"30 x 30 cells, {last['classes']} classes: {1000 * frames / passed:.0f} frames a "
                  f"second, {busy:.1f} ms of processor time each")
            first = last
        browser.close()


if __name__ == "__main__":
    main()
