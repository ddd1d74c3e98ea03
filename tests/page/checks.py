"""What checks of a page share: what went wrong, the page that the tool makes, screenshots, the exit code."""
import base64
import json
import os
import subprocess
import sys

failures = []


def expect(condition, what):
    if not condition:
        failures.append(what)


def make_page(command, folder):
    """Runs the tool, which leaves its page in the folder; returns the report beside it."""
    subprocess.run([*command, "--repeat", "1", "--quiet", "-o", folder], check=True)
    with open(os.path.join(folder, "report.json"), encoding="utf-8") as file:
        return json.load(file)


def leave_screenshot(browser, path):
    with open(path, "wb") as file:
        file.write(base64.b64decode(browser.screenshot(whole=True)))


def finish(browser):
    """Tells what failed, errors of the page too, and ends the program."""
    failures.extend(browser.errors)
    for failure in failures:
        print(failure)
    sys.exit(1 if failures else 0)
