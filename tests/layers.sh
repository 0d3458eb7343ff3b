#!/usr/bin/env bash
# Who may include whom: core <- worlds <- sim <- sensors; core <- slam; scenarios <- everything.
# Embree, Bullet and tinygltf each in one .cpp. No two folders include each other, none is crowded.
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

# Folders are compared as they are: one inside another is a folder of its own. Each exception has its reason.
allowed_pairs='
scenarios/cli scenarios/datasets/export: split_list, of cli.h, splits the words of --format and --with
'
pairs=$(grep -rE '#include "[a-z_]+/' --include='*.h' --include='*.cpp' core worlds sim sensors slam scenarios |
  sed -nE 's|^(.*)/[^/]+:#include "(.*)/[^/]+".*|\1 \2|p' | sort -u |
  awk '$1 != $2 { seen[$1 " " $2] } END { for (pair in seen) {
         split(pair, folder); if (folder[1] < folder[2] && folder[2] " " folder[1] in seen) print pair } }' | sort)
while read -r pair; do
  [ -z "$pair" ] || grep -q "^$pair: " <<<"$allowed_pairs" || {
    echo "these two folders include each other: $pair"
    failed=1
  }
done <<<"$pairs"
while IFS=: read -r pair _; do
  [ -z "$pair" ] || grep -qx "$pair" <<<"$pairs" || {
    echo "these two folders do not include each other any more, take them off the list: $pair"
    failed=1
  }
done <<<"$allowed_pairs"

# x.cpp and x.h are one.
crowded=$(find core worlds sim sensors slam scenarios tests -name '*.cpp' -o -name '*.h' | sed 's/\.[a-z]*$//' | sort -u |
  sed 's|/[^/]*$||' | uniq -c | awk '$1 > 15 { print $2 " has " $1 " source files, more than 15" }')
if [ -n "$crowded" ]; then
  echo "$crowded"
  failed=1
fi

# The estimator knows belief, not truth.
if grep -rnE 'T_world|_world_|world_' --include='*.h' --include='*.cpp' slam; then
  echo 'slam/ says "world": the estimator knows map and odom frames only'
  failed=1
fi
exit $failed
