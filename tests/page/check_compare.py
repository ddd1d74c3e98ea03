"""The page of `vitrail compare -o`, in headless Chromium: it opens without an error and without a network, all that it
shows is there, and the slider moves.

Usage: check_compare.py VITRAIL [PICTURE]     PICTURE: where to leave a screenshot of the whole page"""
import os
import sys
import tempfile

from browser import Browser
from checks import expect, finish, leave_screenshot, make_page

WIDTH, HEIGHT = 96, 64
NOT_EXACT = "The picture that all are compared with is itself not exact."
SMALL = ["--scene", "interlocked", "--count", "3", "--size", f"{WIDTH}x{HEIGHT}", "--passes", "3"]


def check_content(browser, report):
    names = [method["method"] for method in report["methods"]]
    rows = browser.value("[...document.querySelectorAll('#table tbody tr')].map((row) => row.cells[0].textContent)")
    expect(rows == names, f"the table has {rows}, not {names}")
    images = browser.value("[...document.images].map((i) => [i.complete, i.naturalWidth, i.naturalHeight, i.alt])")
    expect(len(images) == 4 + 2 * len(names), f"{len(images)} pictures for {len(names)} methods")
    for complete, width, height, alt in images:
        expect(complete and (width, height) == (WIDTH, HEIGHT) and alt, f"the picture '{alt}' has {width}x{height}")
    for name in ("cost", "error", "memory"):
        drawn = browser.value(f"Chart.getChart('{name}').data.labels")
        expect(drawn == names, f"the chart {name} has {drawn}")
        blank = browser.value(f"(() => {{ const drawn = document.getElementById('{name}'); const blank = drawn.cloneNode();"
                              "return drawn.width === 0 || drawn.toDataURL() === blank.toDataURL(); })()")
        expect(not blank, f"the chart {name} is blank")
    marks = browser.value("[...document.querySelectorAll('#layers-legend span')].map((mark) => mark.textContent)")
    expect(marks[0] == "0" and marks[-1] == str(report["layers_max"]), f"the legend of the layers has {marks}")
    text = browser.value("document.body.innerText")
    for words in (report["device"], "Chart.js 3", "MIT License", "Of the methods that have the option: --passes 3."):
        expect(words in text, f"the page does not say {words}")
    expect(NOT_EXACT not in text, "the page says that the exact picture is not exact")


def check_inexact(browser, page):
    """The same page of a picture that was to be exact and is not."""
    with open(os.path.join(page, "index.html"), encoding="utf-8") as file:
        html = file.read()
    begin = html.index('"exact_picture"')
    with open(os.path.join(page, "inexact.html"), "w", encoding="utf-8") as file:
        file.write(html[:begin] + html[begin:].replace('"exact": true', '"exact": false', 1))
    browser.events.clear()
    browser.open(os.path.join(page, "inexact.html"))
    expect(NOT_EXACT in browser.value("document.body.innerText"), "the page does not say that its exact picture is not")


def check_processor(browser, tool, page):
    """Of the processor alone: times in milliseconds, and nothing is said of a baseline."""
    report = make_page([tool, "compare", *SMALL[:-2], "--methods", "cpu"], page)
    browser.events.clear()
    browser.open(os.path.join(page, "index.html"))
    bars = browser.value("Chart.getChart('cost').data.datasets.map((d) => [d.label, d.data[0]])")
    passes = report["methods"][0]["passes_ms"]
    wanted = [[name.replace("_", " "), time["median"]] for name, time in passes.items() if name != "opaque"]
    expect(sorted(bars) == sorted(wanted), f"the times of the processor are {bars}, not {wanted}")
    text = browser.value("document.body.innerText")
    for words in ("times unsorted", "those of unsorted", "GPU time", "null", "undefined", "NaN", "()", " nodes"):
        expect(words not in text, f"the page of the processor says {words}")
    for words in ("Time, ms, by pass", "time by the clock"):
        expect(words in text, f"the page of the processor does not say {words}")


def place_of_handle(browser):
    return browser.value("(() => { const slider = document.getElementById('slider').getBoundingClientRect();"
                         "const handle = document.getElementById('handle').getBoundingClientRect();"
                         "return (handle.x + handle.width / 2 - slider.x) / slider.width; })()")


def check_slider(browser):
    browser.value("document.getElementById('slider').scrollIntoView({ block: 'center' })")
    box = browser.value("document.getElementById('slider').getBoundingClientRect().toJSON()")
    clip = {name: box[name] for name in ("x", "y", "width", "height")}
    clip["y"] += browser.value("scrollY")
    at = lambda share: (box["x"] + share * box["width"], box["y"] + box["height"] / 2)
    before = browser.screenshot(clip)
    expect(abs(place_of_handle(browser) - 0.5) < 0.01, "the slider does not begin in the middle")
    browser.mouse("mousePressed", *at(0.5), True)
    browser.mouse("mouseMoved", *at(0.4), True)
    browser.mouse("mouseMoved", *at(0.2), True)
    browser.mouse("mouseReleased", *at(0.2), True)
    expect(abs(place_of_handle(browser) - 0.2) < 0.01, f"dragged to 0.2, the slider is at {place_of_handle(browser)}")
    expect(browser.screenshot(clip) != before, "the slider moved and the picture did not change")
    browser.mouse("mouseMoved", *at(0.8), False)
    expect(abs(place_of_handle(browser) - 0.2) < 0.01, "the slider moves without being held")
    browser.value("document.getElementById('handle').focus()")
    browser.key("End")
    expect(abs(place_of_handle(browser) - 1.0) < 0.01, "the key End does not move the slider")
    # All of the left picture is seen: choosing another one there changes what is seen.
    left = browser.screenshot(clip)
    browser.value("(() => { const left = document.getElementById('left'); left.selectedIndex = 0;"
                  "left.dispatchEvent(new Event('change')); return document.getElementById('slider-left').decode(); })()")
    expect(browser.screenshot(clip) != left, "another picture was chosen and none is seen")


def main():
    tool, picture = sys.argv[1], sys.argv[2:3]
    with tempfile.TemporaryDirectory(dir=os.getcwd()) as folder: # not /tmp: a snap does not see it
        page = os.path.join(folder, "page")
        report = make_page([tool, "compare", *SMALL], page)
        browser = Browser()
        try:
            browser.open(os.path.join(page, "index.html"))
            check_content(browser, report)
            if picture:
                leave_screenshot(browser, picture[0])
            check_slider(browser)
            check_inexact(browser, page)
            check_processor(browser, tool, os.path.join(folder, "processor"))
        finally:
            browser.close()
    finish(browser)


main()
