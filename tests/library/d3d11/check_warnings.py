#!/usr/bin/env python3
"""Wine in the part of Direct3D 11's debug layer: check_warnings.py PROGRAM [ARGUMENT]...

Runs a program for Windows with Wine's warnings of Direct3D on, and fails for each that is not of Wine's own making."""
import os
import re
import subprocess
import sys

# Formats and presentation modes that the device below has not; a texture that Wine itself moves between its places; the
# name that it has for the device.
KNOWN = {
    "init_vulkan_format_info",
    "wined3d_swapchain_vk_create_vulkan_swapchain",
    "wined3d_texture_load_location",
}


def main():
    environment = dict(os.environ, WINEDEBUG="-all,warn+d3d,warn+d3d11,err+d3d,err+d3d11")
    run = subprocess.run(sys.argv[1:], env=environment, capture_output=True, text=True, errors="replace", check=False)
    said = re.findall(r"^[0-9a-f]+:((?:warn|err):d3d\w*:(\w+) .*)$", run.stderr, re.MULTILINE)
    ours = sorted({line for line, function in said if function not in KNOWN})
    print("\n".join(ours))
    if run.returncode != 0:
        sys.exit(f"{sys.argv[1]} has failed:\n{run.stdout}{run.stderr}")
    if not said:
        sys.exit("Wine has said nothing at all: not even which formats there are not")
    if ours:
        sys.exit(f"{len(ours)} warnings")


main()
