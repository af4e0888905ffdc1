# Builds duet-server and duet, and packs them with the libraries that they load and nothing else: LibTorch,
# the server's other engine, is not among them.
#
#   docker build -t duet .
#   docker run --rm -p 50051:50051 -p 9464:9464 duet
#
# The container runs as an unprivileged user and writes nothing: --read-only and --cap-drop=ALL are
# fine, and deploy/README.md says more.

FROM debian:bookworm-slim AS build
WORKDIR /src
# The package list alone first, so that a change to the sources does not install it again.
COPY packages/build.txt packages/
COPY scripts/install_packages.sh scripts/
RUN scripts/install_packages.sh build && rm -rf /var/lib/apt/lists/*
COPY . .
RUN cmake --preset release -DDUET_BUILD_TESTS=OFF -DDUET_BUILD_BENCHMARKS=OFF \
    && cmake --build --preset release --parallel "$(scripts/build_jobs.sh)" \
       --target duet-server duet \
    && strip build/release/bin/duet-server build/release/bin/duet

FROM debian:bookworm-slim AS runtime
LABEL org.opencontainers.image.title="Duet" \
      org.opencontainers.image.description="Answers one character's motion with another's, over gRPC"
COPY packages/runtime.txt /tmp/install/packages/
COPY scripts/install_packages.sh /tmp/install/scripts/
RUN /tmp/install/scripts/install_packages.sh runtime \
    && rm -rf /tmp/install /var/lib/apt/lists/* /var/cache/apt/* /var/log/apt /var/log/dpkg.log
COPY --from=build /src/build/release/bin/duet-server /src/build/release/bin/duet /usr/local/bin/
# By number: a cluster can then see that it is not root.
USER 65532:65532
# gRPC; Prometheus metrics.
EXPOSE 50051 9464
STOPSIGNAL SIGTERM
# Every check opens a connection of its own: a listener that lost its descriptors fails it.
HEALTHCHECK --interval=10s --timeout=5s --start-period=30s --retries=3 \
    CMD ["duet", "models", "--server", "127.0.0.1:50051"]
ENTRYPOINT ["duet-server"]
