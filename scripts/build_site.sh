#!/usr/bin/env bash
# Builds the site: every document, the Python API and the wire contract, as static pages. Fails on a broken
# link.
#   scripts/build_site.sh [folder]            (build/site; open its index.html)
#   scripts/build_site.sh folder --no-cpp     without the C++ reference, which needs Doxygen
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

out="${1:-build/site}"
for module in sphinx myst_parser furo; do
  /usr/bin/python3 -c "import ${module}" 2>/dev/null || {
    echo "build_site.sh: expected the Python module ${module}, got none; install the packages of packages/test.txt" >&2
    exit 1
  }
done

tags=()
if [[ "${2:-}" != --no-cpp ]]; then
  command -v doxygen >/dev/null || { echo "build_site.sh: expected doxygen, got none; install it or use --no-cpp" >&2 && exit 1; }
  mkdir -p build/docs
  doxygen docs/Doxyfile >/dev/null
  tags=(-t cpp)
fi
/usr/bin/python3 -B -m sphinx -c docs/site -b html -d build/doctrees -q -W --keep-going \
  ${tags[@]+"${tags[@]}"} . "${out}"
if [[ ${#tags[@]} -gt 0 ]]; then
  rm -rf "${out}/cpp"
  cp -r build/docs/html "${out}/cpp"
fi
echo "Site: $(find "${out}" -name '*.html' -not -path '*/cpp/*' | wc -l) pages, ${out}/index.html."
