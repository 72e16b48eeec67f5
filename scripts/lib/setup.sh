# Sourced by scripts/demo, scripts/build, scripts/test and others: installs what is missing, and builds the package in a workspace of
# its own.

set -euo pipefail

checkout=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd -P)
# Hidden in build/ because rosrun searches a whole package for executables, but not its build/, and roslaunch no hidden
# directories: where the checkout lies in a user's own workspace, neither must find every program twice.
workspace=$checkout/build/.ws

fail() {
  echo "$(basename "$0"): $*" >&2
  exit 1
}

# A python3, cmake or ROS workspace of the user's, in front of the distribution's, would break the build.
export PATH=/usr/sbin:/usr/bin:/sbin:/bin
unset PYTHONPATH PYTHONHOME VIRTUAL_ENV CMAKE_PREFIX_PATH PKG_CONFIG_PATH
unset ROS_PACKAGE_PATH ROS_ROOT ROS_DISTRO ROS_ETC_DIR ROSLISP_PACKAGE_DIRECTORIES ROS_NAMESPACE
export LC_ALL=C.UTF-8 ROSCONSOLE_STDOUT_LINE_BUFFERED=1 PYTHONUNBUFFERED=1

# Everything runs on this machine, also where its name does not resolve.
unset ROS_IP
export ROS_HOSTNAME=localhost

# ROS's setup files use variables that may be unset.
source_setup() {
  set +u
  source "$1"
  set -u
}

# The only list of system packages: to build, to run and to test; and, with a display only, to look at it. These are all that the Python
# package needs.
library_packages=(
  build-essential cmake libassimp-dev libceres-dev libcli11-dev libconsole-bridge-dev libeigen3-dev libembree-dev libtbb-dev liburdfdom-dev
  libyaml-cpp-dev nlohmann-json3-dev pybind11-dev python3-dev python3-numpy python3-setuptools python3-yaml
)
# And with pip.
pip_packages=(python3-pip python3-venv python3-wheel)

packages=("${library_packages[@]}" iproute2 libgtest-dev python3-pytest)
if [[ -f /opt/ros/noetic/setup.bash ]]; then
  source_setup /opt/ros/noetic/setup.bash
  packages+=(
    ros-noetic-{catkin,message-generation,message-runtime,roscpp,rospy,rosbash,roslaunch,rostest,rosbag,rosservice,rostopic}
    ros-noetic-{actionlib,diagnostic,geometry,sensor,std,visualization}-msgs ros-noetic-std-srvs
    ros-noetic-{actionlib,diagnostic-updater,dynamic-reconfigure,nodelet,pluginlib,robot-state-publisher,roslib,tf2,tf2-msgs,tf2-ros}
  )
  rviz_packages=(ros-noetic-rviz qtbase5-dev)
  fuzz_packages=(clang)  # with its sanitizers
else
  packages+=(
    catkin catkin-lint ros-message-generation ros-message-runtime ros-environment ros-robot-state-publisher rosbash roslang rospack-tools rosout tf2-tools
    libroscpp-dev libroslib-dev libactionlib-dev libdiagnostic-updater-dev libdynamic-reconfigure-config-init-mutex-dev
    libnodelet-dev libnodeletlib-dev libnodeletlib-tools pluginlib-dev libtf2-dev libtf2-msgs-dev libtf2-ros-dev librostest-dev librosbag-dev
    lib{std,geometry,sensor,visualization,diagnostic,actionlib}-msgs-dev libstd-srvs-dev
    ros-{std,geometry,sensor,visualization,diagnostic,actionlib}-msgs ros-std-srvs
    python3-{std,geometry,sensor,visualization,diagnostic,actionlib}-msgs python3-std-srvs
    python3-{actionlib,dynamic-reconfigure,rospy,tf2-ros,roslaunch,rostest,rosbag,rosservice,rostopic}
  )
  rviz_packages=(rviz librviz-dev qtbase5-dev libgl1-mesa-dri)
  fuzz_packages=(clang libclang-rt-dev)
fi

# Besides these, for cable_sweep: the node and the other programs need none of them.
sweep_packages=(python3-dask python3-distributed python3-zarr)

# Besides those, for the pages of doc/python, which scripts/test and scripts/pictures run.
page_packages=(python3-matplotlib python3-pil python3-scipy)

# For scripts/fuzz --coverage only.
coverage_packages=(llvm)

# And for scripts/test only.
test_packages=(mypy python3-xarray)

# And for scripts/docs only; Ubuntu 20.04's are too old, or missing.
docs_packages=(
  doxygen fonts-mathjax furo libjs-mathjax python3-breathe python3-myst-parser python3-sphinx python3-sphinx-copybutton
)

# as_root COMMAND...: needs sudo where the user is not root.
as_root() {
  if [[ $(id -u) == 0 ]]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    fail "not root, and no sudo, for: $*"
  fi
}

# catkin_make alone would not look again for what was not there when it first configured.
configure_anew=()

# install_packages PACKAGE...: asks dpkg first, and does nothing where all are installed.
install_packages() {
  local installed missing apt=(env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300 -o Dpkg::Use-Pty=0)
  installed=$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' "$@" 2>/dev/null | sed -n 's/^installed //p' || true)
  mapfile -t missing < <(printf '%s\n' "$@" | grep -vxF -e "$installed")
  [[ ${#missing[@]} -gt 0 ]] || return 0
  echo "Installing: ${missing[*]}"
  as_root "${apt[@]}" update || echo "apt-get update failed, going on with the package lists there are" >&2
  as_root "${apt[@]}" install -y --no-install-recommends "${missing[@]}" || fail "apt-get could not install ${missing[*]}"
  configure_anew=(--force-cmake)
}

# A root file system without /etc/hosts (a container, a chroot) may not know the names that roslaunch gives this machine: localhost
# from here, the machine's own name in another terminal.
name_localhost() {
  local name
  for name in localhost "$(uname -n)"; do
    getent hosts "$name" >/dev/null && continue
    echo "Adding $name to /etc/hosts"
    echo "127.0.0.1 $name" | as_root tee -a /etc/hosts >/dev/null
  done
}

# Two builds, or a build and a test run, of one checkout wait for each other. Held until unlock_workspace or the end.
lock_workspace() {
  mkdir -p "$workspace"
  exec 9>"$workspace/lock"
  flock -n 9 || { echo "Waiting for another build or test run in $workspace"; flock 9; }
}

unlock_workspace() {
  exec 9>&-
}

# The package in the workspace is a directory of links to what is in the checkout: a single link to the checkout, which
# contains the workspace, would be a loop for everything that searches a package.
link_package() {
  local package=$workspace/src/verlet_cable entry
  mkdir -p "$package"
  find "$package" -xtype l -delete
  for entry in "$checkout"/*; do
    entry=${entry##*/}
    [[ $entry == build || -e $package/$entry ]] || ln -s "../../../../$entry" "$package/"
  done
}

# What a script's build needs besides CMake's defaults.
cmake_arguments=()

# The node, in a process of its own or as a nodelet, what its scripts and rviz need of the package, and cable_sim.
live_targets=(
  cable_node cable_sim mesh_reader verlet_cable_generate_messages_py verlet_cable_nodelet verlet_cable_rviz
)

# build_workspace TARGET...: make's targets. Goes on after an error, so that one broken file hides no other error.
build_workspace() {
  local cache=$workspace/build/CMakeCache.txt
  [[ $checkout != *[[:space:]]* ]] || fail "ROS cannot build in a path with spaces: $checkout"
  # What was configured in another place (the checkout was moved or copied) cannot be built here.
  if [[ -f $cache ]] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$workspace/src" "$cache"; then
    rm -rf "$workspace/build" "$workspace/devel"
  fi
  link_package
  # catkin leaves this directory out of PYTHONPATH for good if it does not exist when it first configures.
  mkdir -p "$workspace/devel/lib/python3/dist-packages"
  # So that it is seen in the logs when a build takes longer than it did.
  local TIMEFORMAT="Built in %R s, with %U s of processor time: ${*:-all}"
  time catkin_make -C "$workspace" -j"$(nproc)" "${configure_anew[@]}" --cmake-args -DPYTHON_EXECUTABLE=/usr/bin/python3 "${cmake_arguments[@]}" \
    --make-args -k "$@"
}
