# Functions of ./vitrail and ./test: install what is missing, configure, build. Sourced with $root set.

say() { printf 'vitrail: %s\n' "$*" >&2; }

die() {
  printf 'vitrail: error: %s\n' "$*" >&2
  exit 1
}

# The packages of the given groups in packages.txt, for this system.
packages_of() {
  local group name only system
  system=$(. /etc/os-release && printf '%s' "$ID")
  while read -r group name only; do
    [ "${only:-$system}" = "$system" ] || continue
    case " $* " in *" $group "*) printf '%s\n' "$name" ;; esac
  done < <(grep -v '^#' "$root/packages.txt")
}

# install_packages GROUP...: installs what is missing with apt, with sudo where this is not root.
install_packages() {
  command -v dpkg-query >/dev/null && command -v apt-get >/dev/null ||
    die "this needs Debian 12, Ubuntu 24.04 or a later one of either; elsewhere install what packages.txt names and run cmake --preset release"
  local wanted missing name
  mapfile -t wanted < <(packages_of "$@")
  missing=()
  for name in "${wanted[@]}"; do
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$name" 2>/dev/null)" = installed ] || missing+=("$name")
  done
  [ ${#missing[@]} -gt 0 ] || return 0

  local as_root=()
  if [ "$(id -u)" != 0 ]; then
    as_root=(sudo)
    [ -t 0 ] || as_root+=(-n) # nobody is there to type a password
  fi
  local by_hand="sudo apt-get update && sudo apt-get install --no-install-recommends ${missing[*]}"
  if [ ${#as_root[@]} -gt 0 ] && ! { command -v sudo >/dev/null && "${as_root[@]}" true 2>/dev/null; }; then
    die "packages are missing and sudo is not allowed here; as root, run: ${by_hand//sudo /}"
  fi
  say "installing ${missing[*]}"
  local log
  log=$(mktemp)
  if ! { "${as_root[@]}" apt-get update && "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
    tail -n 20 "$log" >&2
    rm -f "$log"
    die "apt-get failed; mend what it says above, or run: $by_hand"
  fi
  rm -f "$log"
}

# build PRESET [NAME=VALUE...]: configures where needed, also where CMake's cache has other values than these, and builds;
# silent unless it fails.
build() {
  local preset=$1 folder="$root/build/$1" log setting
  shift
  mkdir -p "$folder"
  log="$folder/build.log"
  : >"$log"
  # CMake does not notice changed presets by itself.
  if [ ! -f "$folder/build.ninja" ] || [ "$root/CMakePresets.json" -nt "$folder/build.ninja" ]; then
    (cd "$root" && cmake --preset "$preset" "${@/#/-D}") >"$log" 2>&1 ||
      { cat "$log" >&2; die "cmake could not configure preset $preset"; }
    touch "$folder/build.ninja"
  fi
  for setting; do
    [ "$(sed -n "s/^${setting%%=*}:[^=]*=//p" "$folder/CMakeCache.txt")" != "${setting#*=}" ] || continue
    cmake "-D$setting" "$folder" >"$log" 2>&1 || { cat "$log" >&2; die "cmake could not configure preset $preset"; }
  done
  (cd "$root" && cmake --build --preset "$preset") >>"$log" 2>&1 ||
    { tail -n 60 "$log" >&2; die "the build of preset $preset failed"; }
}

# Microsoft's HLSL compilers, which the npm package webgpu carries, into build/direct3d/compilers.
fetch_hlsl_compilers() {
  local version=0.6.2 folder="$root/build/direct3d/compilers" name
  [ ! -f "$folder/dxcompiler.dll" ] || return 0
  command -v npm >/dev/null || install_packages npm
  mkdir -p "$folder/package"
  say "fetching Microsoft's HLSL compilers (npm package webgpu $version)"
  (cd "$folder/package" && npm pack --silent "webgpu@$version" >/dev/null && tar xzf "webgpu-$version.tgz") ||
    die "npm could not fetch webgpu $version; put d3dcompiler_47.dll and dxcompiler.dll into $folder by hand"
  for name in d3dcompiler_47.dll dxcompiler.dll; do
    mv "$folder/package/package/dist/win32-x64/$name" "$folder/$name"
  done
  rm -rf "$folder/package"
}
