# Sourced by ./demo and ./check, from the top of the checkout: packages, and an environment that needs no home.
# shellcheck shell=bash disable=SC2034

# OpenImageIO's CMake package wants its tools to be there (openimageio-tools).
build_packages=(g++ cmake ninja-build pkg-config pocl-opencl-icd ocl-icd-opencl-dev libopenimageio-dev openimageio-tools
  zlib1g-dev libeigen3-dev libcli11-dev nlohmann-json3-dev libfmt-dev libfftw3-dev catch2 python3)

jobs=$(nproc)
logs=$PWD/build/logs
mkdir -p "$logs"

# Kernels that PoCL has compiled; its own choice needs HOME.
export POCL_CACHE_DIR=${POCL_CACHE_DIR:-$PWD/build/pocl-cache}
mkdir -p "$POCL_CACHE_DIR"

# Where another run of apt holds a lock, this one waits for so many seconds.
apt_wait=600

# say TEXT...: a line for the person who watches.
say() { printf '%s\n' "$*"; }

# update_lists COMMAND...: runs the command with apt-get update. DPkg::Lock::Timeout does not wait for the lock of the package lists.
update_lists() {
  local end=$((SECONDS + apt_wait))
  until "$@" apt-get update -qq; do
    { tail -n 4 "$logs/apt.log" | grep -q lists/lock && [ $SECONDS -lt $end ]; } || return 1
    sleep 2
  done
}

# install_packages NAME...: installs what is missing. On a system without dpkg it trusts that all is there.
install_packages() {
  command -v dpkg-query >/dev/null || return 0
  local missing=() name as_root=()
  for name in "$@"; do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$name" 2>/dev/null)" = installed ] || missing+=("$name")
  done
  [ ${#missing[@]} -gt 0 ] || return 0

  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      say "missing packages; as root: apt-get install --no-install-recommends ${missing[*]}" >&2
      return 1
    fi
    as_root=(sudo)
  fi
  say "installing ${missing[*]}"
  {
    update_lists "${as_root[@]}" &&
      "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=$apt_wait install -qq -y \
        --no-install-recommends "${missing[@]}"
  } </dev/null >"$logs/apt.log" 2>&1 || {
    tail -n 30 "$logs/apt.log" >&2
    return 1
  }
}

# configure: both scripts build the same files with the same flags, so that the second compiles only what is new.
configure() { cmake --preset release -DDERMIS_WERROR=ON; }
