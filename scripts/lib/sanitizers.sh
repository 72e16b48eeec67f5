# Sourced by scripts/sanitize and scripts/soak: builds with clang's sanitizers.

sanitizer_packages=("${fuzz_packages[@]}" llvm)

# prepare_sanitizer address|thread: a workspace of its own, and what to build with. Asserts are on.
prepare_sanitizer() {
  local checks=thread
  [[ $1 == thread ]] || checks=address,undefined
  workspace=$checkout/build/.sanitize_$1
  export CC=clang CXX=clang++
  cmake_arguments+=(-DCMAKE_BUILD_TYPE=RelWithDebInfo "-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O1 -gline-tables-only"
    "-DCMAKE_CXX_FLAGS=-fsanitize=$checks -fno-sanitize-recover=undefined -fno-omit-frame-pointer")
}

# watch_reports DIRECTORY: empties it, and has all programs write their reports there.
watch_reports() {
  rm -rf "$1"
  mkdir -p "$1"
  # What ROS itself and its plugins leave at the end is not the package's.
  export ASAN_OPTIONS=log_path=$1/report:detect_leaks=0:detect_stack_use_after_return=1
  export UBSAN_OPTIONS=log_path=$1/report:print_stacktrace=1
  export TSAN_OPTIONS=log_path=$1/report:second_deadlock_stack=1
}
