"""The page of `vitrail bench -o`, in headless Chromium: it opens without an error and without a network, every chart is
there with every method in its colour, and so are the advice, the tables and what was skipped.

Usage: check_bench.py VITRAIL [NAME]     NAME: what files begin with in which to leave screenshots of the pages"""
import os
import sys
import tempfile

from browser import Browser
from checks import expect, finish, leave_screenshot, make_page


def setting_of(scene, measured):
    several = measured["samples"] > 1 and scene["sweep"] != "samples"
    return measured["setting"] + (f", {measured['samples']} samples" if several else "")


def check_chart(browser, name, scenes, of, colors):
    settings = list(dict.fromkeys(setting_of(scene, m) for scene in scenes for m in scene["measurements"]))
    drawn = browser.value(f"Chart.getChart('{name}')?.data.datasets.map((d) => [d.label, d.borderColor,"
                          "d.data.map((point) => point?.y ?? point)])")
    expect(drawn and [data[0] for data in drawn] == settings, f"the chart {name} has {drawn}, not {settings}")
    for label, color, values in drawn or []:
        expect(colors.setdefault(label, color) == color, f"{label} has two colours, one of them in {name}")
        for scene, value in zip(scenes, values):
            found = [of(m) for m in scene["measurements"] if setting_of(scene, m) == label]
            wanted = found[0] if found and found[0] and found[0] > 0 else None
            value = value if isinstance(value, (int, float)) else None
            expect(wanted is value is None or (wanted and value and abs(value / wanted - 1) < 1e-9),
                   f"{label} in {name} is {value}, not {wanted}")
    blank = browser.value(f"(() => {{ const drawn = document.getElementById('{name}'); const blank = drawn.cloneNode();"
                          "return drawn.width === 0 || drawn.toDataURL() === blank.toDataURL(); })()")
    expect(not blank, f"the chart {name} is blank")


def check_content(browser, report):
    groups = {}
    for scene in report["scenes"]:
        groups.setdefault(scene["sweep"] or "scenes", []).append(scene)
    by_processor = report["api"] == "CPU"
    measures = {} if by_processor else {"ratio": lambda m: m["cost_ratio"]}
    measures["memory"] = lambda m: m["memory_bytes"] / 2**20
    if not report["cpu"] or by_processor:
        measures["cost"] = lambda m: m["cost_ms"]["median"]
    colors = {}
    for group, scenes in groups.items():
        for measure, of in measures.items():
            drawn = [scene for scene in scenes if scene["measurements"]]
            check_chart(browser, f"{group}-{measure}", drawn, of, colors)
    charts = browser.value("[...document.querySelectorAll('canvas')].map((canvas) => canvas.id)")
    expect(len(charts) == len(groups) * len(measures), f"there are the charts {charts}")
    expect(len(set(colors.values())) == len(colors), f"methods share a colour: {colors}")
    text = browser.value("document.body.innerText")
    for words in (report["device"], "Chart.js 3", "MIT License", *(part["text"] for part in report["recommendation"])):
        expect(words in text, f"the page does not say {words}")
    tables = browser.value("[...document.querySelectorAll('table')].map((t) => [t.rows.length, t.rows[0].cells.length])")
    sizes = [[1 + len({setting_of(scene, m) for scene in scenes for m in scene["measurements"]}), 1 + len(scenes)]
             for scenes in groups.values() for _ in measures]
    expect(tables == sizes, f"the tables have {tables} rows and columns, not {sizes}")
    check_skipped(browser, groups.values())
    check_overflowed(browser, report)


def check_overflowed(browser, report):
    """A frame that had more fragments than nodes is marked in every table, and the mark is told."""
    count = sum(m["overflowed"] for scene in report["scenes"] for m in scene["measurements"])
    tables = browser.value("document.querySelectorAll('table').length") / len({s["sweep"] for s in report["scenes"]})
    marked = browser.value("[...document.querySelectorAll('td')].filter((cell) => cell.textContent.endsWith('†')).length")
    expect(marked == count * tables, f"{marked} cells are marked as overflowed, not {count * tables}")
    told = browser.value("document.body.innerText").count("† Not exact")
    expect((told > 0) == (count > 0), f"the mark of overflowed frames is told {told} times")


def check_skipped(browser, groups):
    """Every setting that was skipped is named once, with the scenes or steps at which it was if not at all of them."""
    wanted = []
    for scenes in groups:
        where = {}
        for scene in scenes:
            everything = not scene["measurements"]
            for skipped in scene["skipped"]:
                if everything and skipped["method"] != "unsorted":
                    continue
                name = "every method" if everything else setting_of(scene, skipped)
                count = "" if scene["count"] is None else f" × {scene['count']}"
                where.setdefault(f"{name}: {skipped['reason']}", []).append(scene["label"] or scene["scene"] + count)
        wanted += [text if len(at) == len(scenes) else f"at {', '.join(at)}: {text}" for text, at in where.items()]
    told = browser.value("[...document.querySelectorAll('.skipped li')].map((item) => item.textContent)")
    expect(told == wanted, f"the page tells of skipped settings {told}, not {wanted}")


def check_hiding(browser):
    seen = "charts.map((chart) => chart.getVisibleDatasetCount())"
    before = browser.value(seen)
    press = "document.querySelector('#methods button').click()"
    browser.value(press)
    expect(browser.value(seen) == [count - 1 for count in before], "a method that was switched off is still drawn")
    browser.value(press)
    expect(browser.value(seen) == before, "a method that was switched on again is not drawn")


def check_dark(browser):
    ink = "charts[0].options.scales.x.ticks.color"
    light = browser.value(ink)
    browser.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark"}])
    browser.value("new Promise((done) => requestAnimationFrame(() => setTimeout(done, 50)))")
    expect(browser.value(ink) != light, "the charts stay light on a dark page")


def main():
    tool, picture = sys.argv[1], sys.argv[2:3]
    with tempfile.TemporaryDirectory(dir=os.getcwd()) as folder:  # not /tmp: a snap does not see it
        small = ["--size", "32x24"]
        two = ["--methods", "linked-list,insertion", *small]
        # More settings than the palette has colours.
        many = ["--nodes", "standard,compact,hdr", "--samples", "1,8", *small]
        browser = Browser()
        try:
            for name, arguments in {
                "sweeps": ["--sweep", "layers,triangles,samples", "--count", "1", *two],
                "scenes": ["--scene", "planes,interlocked", *many],
                "overflow": ["--sweep", "cap", "--count", "8", "--methods", "linked-list", "--overflow", "approximate",
                             "--node-capacity", "20,100000", *small],
                "processor": ["--scene", "planes,interlocked", "--methods", "cpu", *small],
            }.items():
                page = os.path.join(folder, name)
                report = make_page([tool, "bench", *arguments], page)
                browser.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "light"}])
                browser.events.clear()
                browser.open(os.path.join(page, "index.html"))
                check_content(browser, report)
                check_hiding(browser)
                if picture:
                    leave_screenshot(browser, f"{picture[0]}-{name}-light.png")
                check_dark(browser)
                if picture:
                    leave_screenshot(browser, f"{picture[0]}-{name}-dark.png")
        finally:
            browser.close()
    finish(browser)


main()
