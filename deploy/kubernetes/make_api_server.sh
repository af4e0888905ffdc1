#!/usr/bin/env bash
# Builds kube-apiserver from Debian 12's source package of Kubernetes, the only API server that Debian's or
# npm's packages have: 1.20, for tests/e2e/api_server_test.py. Takes a quarter of an hour of two cores.
#   deploy/kubernetes/make_api_server.sh FOLDER      FOLDER/kube-apiserver
# Needs the packages golang-go, dpkg-dev and, for the test, etcd-server; deb-src in apt's sources.
set -euo pipefail

readonly out="${1:?make_api_server.sh: wanted a folder}"
mkdir -p "${out}"
work="$(mktemp -d)"
readonly work
trap 'rm -rf "${work}"' EXIT

(cd "${work}" && apt-get source --download-only kubernetes/bookworm)
# Before modules: the source lies where its import path says.
readonly source="${work}/go/src/k8s.io/kubernetes"
mkdir -p "${source}"
tar --extract --file "$(compgen -G "${work}/kubernetes_*.orig.tar.gz")" --directory "${source}" \
  --strip-components=1

version="$(sed -n 's/^kubernetes-\([0-9.]*\)\/$/\1/p' \
  < <(tar --list --file "$(compgen -G "${work}/kubernetes_*.orig.tar.gz")" | sed -n 1p))"
readonly component=k8s.io/kubernetes/vendor/k8s.io/component-base/version
cd "${source}"
GO111MODULE=off GOPATH="${work}/go" GOCACHE="${work}/cache" CGO_ENABLED=0 go build -tags providerless \
  -ldflags "-s -w -X ${component}.gitVersion=v${version} -X ${component}.gitMajor=1 \
    -X ${component}.gitMinor=$(cut -d. -f2 <<<"${version}")" \
  -o "$(realpath -m "${OLDPWD}/${out}")" ./cmd/kube-apiserver
echo "${out}/kube-apiserver: Kubernetes ${version}"
