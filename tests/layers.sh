#!/usr/bin/env bash
# Who may include whom: core <- worlds <- sim <- sensors; core <- slam; scenarios <- everything.
# Embree, Bullet and tinygltf each in one .cpp.
set -u
cd "$1" || exit 2
failed=0

check_room() {  # room, then the rooms it may include
  local room=$1
  shift
  local allowed="$room $*"
  while IFS=: read -r file line include; do
    target=$(sed -E 's/.*#include "([a-z_]+)\/.*/\1/' <<<"$include")
    case " $allowed " in
      *" $target "*) ;;
      *) echo "$file:$line: $room/ may not include $target/ (allowed: $allowed)"; failed=1 ;;
    esac
  done < <(grep -rnE '#include "[a-z_]+/' --include='*.h' --include='*.cpp' "$room" || true)
}
check_room core
check_room worlds core
check_room sim core worlds
check_room sensors core worlds sim
check_room slam core
check_room scenarios core worlds sim sensors slam

check_single() {  # what, pattern: at most one .cpp and no header of the product includes it
  local files
  files=$(grep -rlE "#include [<\"]$2" --include='*.h' --include='*.cpp' core worlds sim sensors slam scenarios || true)
  if [ "$(grep -c . <<<"$files")" -gt 1 ] || grep -q '\.h$' <<<"$files"; then
    printf '%s is included by more than one .cpp, or by a header:\n%s\n' "$1" "$files"
    failed=1
  fi
}
check_single Embree embree
check_single Bullet '(bt[A-Z]|bullet/|Bullet)'
check_single tinygltf tiny_gltf

# The estimator knows belief, not truth.
if grep -rnE 'T_world|_world_|world_' --include='*.h' --include='*.cpp' slam; then
  echo 'slam/ says "world": the estimator knows map and odom frames only'
  failed=1
fi
exit $failed
