# SPDX-License-Identifier: MIT
"""The site as tools/docs has built it, in a browser: every page is as wide as a phone and says nothing to the console,
and the search finds a function of C."""

import functools
import http.server
import threading
from pathlib import Path

import pytest
from playwright.sync_api import sync_playwright

SITE = Path(__file__).resolve().parents[2] / "build/docs/site"
PAGES = sorted(path.relative_to(SITE).as_posix() for path in SITE.rglob("*.html") if path.parent.name != "playground")


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


@pytest.fixture(scope="module")
def address():
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=SITE))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}"
    server.shutdown()
    server.server_close()


@pytest.fixture
def page():
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path="/usr/bin/chromium", args=["--no-sandbox"])
        yield browser.new_page(viewport={"width": 390, "height": 844})
        browser.close()


def test_pages(page, address):
    said = []
    page.on("console", lambda message: said.append(f"{page.url}: {message.text}"))
    page.on("pageerror", lambda error: said.append(f"{page.url}: {error}"))
    assert len(PAGES) > 30
    for name in PAGES:
        page.goto(f"{address}/{name}", wait_until="load")
        if page.evaluate("document.documentElement.scrollWidth > innerWidth"):
            said.append(f"{page.url}: wider than the screen")
        if page.evaluate("[...document.images].some((image) => image.complete && image.naturalWidth === 0)"):
            said.append(f"{page.url}: a picture is missing")
    assert said == []


def test_search(page, address):
    page.set_viewport_size({"width": 1280, "height": 900})
    page.goto(f"{address}/index.html?q=rlvc_agent_init")  # what is typed before the page is ready is lost
    # Of several hits on a page all but the first are folded.
    page.wait_for_selector(".md-search-result__link[href*='c/agent.html']", state="attached", timeout=120_000)
