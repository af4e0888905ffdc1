#!/usr/bin/env bash
# Makes a certificate for localhost in tls/ for trying the compose file: proxy.pem for HAProxy, cert.pem for
# callers. Keeps an existing one.
#   deploy/compose/make_certificate.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

[[ ! -e tls/proxy.pem ]] || { echo "tls/proxy.pem is there already." && exit 0; }
mkdir -p tls
openssl req -x509 -newkey rsa:2048 -nodes -days 90 -subj /CN=localhost \
  -addext subjectAltName=DNS:localhost,DNS:proxy,IP:127.0.0.1 \
  -keyout tls/key.pem -out tls/cert.pem 2>/dev/null
cat tls/cert.pem tls/key.pem >tls/proxy.pem
rm tls/key.pem
# The proxy runs as another user than this script, and the certificate is only for trying.
chmod 644 tls/proxy.pem
echo "tls/proxy.pem and tls/cert.pem are made, for localhost."
