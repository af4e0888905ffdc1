#!/usr/bin/env bash
# Builds kube-apiserver 1.20 from Debian 12's source package of Kubernetes, for tests/e2e/api_server_test.py.
# Neither Debian nor npm has another API server. Takes a quarter of an hour on two cores.
#   deploy/kubernetes/make_api_server.sh FOLDER      FOLDER/kube-apiserver
# Needs the packages golang-go and, for the test, etcd-server. DEBIAN_MIRROR names another mirror of Debian.
set -euo pipefail

mkdir -p "${1:?make_api_server.sh: expected a folder}"
out="$(realpath "$1")"
readonly out
work="$(mktemp -d)"
readonly work
trap 'rm -rf "${work}"' EXIT

# Uses its own sources.list: this machine's may be of another release, or have no source packages.
chmod 755 "${work}"
mkdir -p "${work}/lists/partial"
printf 'deb-src [signed-by=%s] %s bookworm main\n' /usr/share/keyrings/debian-archive-keyring.gpg \
  "${DEBIAN_MIRROR:-http://deb.debian.org/debian}" >"${work}/sources.list"
apt=(apt-get -o "Dir::Etc::SourceList=${work}/sources.list" -o Dir::Etc::SourceParts=-
  -o "Dir::State::Lists=${work}/lists" -o "Dir::Cache=${work}/apt-cache")
"${apt[@]}" update
(cd "${work}" && "${apt[@]}" source --download-only kubernetes)
# The source is older than Go modules, so it must be in the folder of its import path.
readonly source="${work}/go/src/k8s.io/kubernetes"
mkdir -p "${source}"
tar --extract --file "$(compgen -G "${work}/kubernetes_*.orig.tar.gz")" --directory "${source}" \
  --strip-components=1

version="$(sed -n 's/^kubernetes-\([0-9.]*\)\/$/\1/p' \
  < <(tar --list --file "$(compgen -G "${work}/kubernetes_*.orig.tar.gz")" | sed -n 1p))"
cd "${source}"
export GO111MODULE=off GOPATH="${work}/go" GOCACHE="${work}/cache" CGO_ENABLED=0

# The one generated file that the sources lack: descriptions of all types that request one.
mapfile -t described < <(grep -rl --include='*.go' '+k8s:openapi-gen=true' pkg \
  staging/src/k8s.io/{api,apimachinery,apiserver,apiextensions-apiserver,client-go} \
  staging/src/k8s.io/{kube-aggregator,metrics,cloud-provider,controller-manager} \
  staging/src/k8s.io/{kube-controller-manager,kube-proxy,kube-scheduler,kubelet} |
  grep -v /example | xargs -n1 dirname | sort -u |
  sed -e 's#^staging/src/#k8s.io/kubernetes/vendor/#' -e 's#^pkg#k8s.io/kubernetes/pkg#')
go build -o "${work}/openapi-gen" ./vendor/k8s.io/kube-openapi/cmd/openapi-gen
"${work}/openapi-gen" -i "$(IFS=, && echo "${described[*]}")" -O zz_generated.openapi \
  -p k8s.io/kubernetes/pkg/generated/openapi -r "${work}/violations" \
  -h hack/boilerplate/boilerplate.generatego.txt

# Without the cloud providers, which would take half of the time.
readonly component=k8s.io/kubernetes/vendor/k8s.io/component-base/version
go build -tags providerless \
  -ldflags "-s -w -X ${component}.gitVersion=v${version} -X ${component}.gitMajor=1 \
    -X ${component}.gitMinor=$(cut -d. -f2 <<<"${version}")" \
  -o "${out}/kube-apiserver" ./cmd/kube-apiserver
echo "${out}/kube-apiserver: Kubernetes ${version}"
