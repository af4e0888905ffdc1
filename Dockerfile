# Two images. `server` (the last stage, which a plain build makes) holds only duet-server, duet and the
# libraries that they load: no shell, no package manager, no LibTorch. `training` is Debian with LibTorch and
# every program.
#
#   docker build -t duet .
#   docker build -t duet-training --target training .
#   deploy/image/build.sh              the same with podman, with labels filled in
#
# With `--build-arg RESEARCH_WEIGHTS=OFF` (`deploy/image/build.sh --free`) an image contains only weights that
# are free for all uses.
#
# The server's container runs as an unprivileged user and writes nothing; deploy/README.md has the command
# that runs it.

ARG BASE=debian:bookworm-slim

# Compiler and libraries: rebuilt when a package list changes, never for a change to the sources.
FROM ${BASE} AS tools
WORKDIR /src
COPY packages/build.txt packages/build_training.txt packages/image.txt packages/releases.tsv packages/
COPY scripts/install_packages.sh scripts/
RUN scripts/install_packages.sh build build_training image && rm -rf /var/lib/apt/lists/*

# The compiler cache provides unchanged objects.
FROM tools AS build
ARG CCACHE_DIR=/var/cache/ccache
# OFF: without the weights that are for research only.
ARG RESEARCH_WEIGHTS=ON
# Additional CMake arguments.
ARG CMAKE_FLAGS=
# Identifies the compiler by content: all files of an image have the same time.
ENV LANG=C.UTF-8 CCACHE_DIR=$CCACHE_DIR CCACHE_BASEDIR=/src CCACHE_NOHASHDIR=1 \
    CCACHE_COMPILERCHECK=content
COPY . .
RUN --mount=type=cache,id=duet-ccache,target=/var/cache/ccache \
    cmake --preset release -DDUET_BUILD_TESTS=OFF -DDUET_BUILD_BENCHMARKS=OFF $CMAKE_FLAGS \
       -DDUET_RESEARCH_WEIGHTS="$RESEARCH_WEIGHTS" \
    && cmake --build --preset release --parallel "$(scripts/build_jobs.sh)" \
       --target duet-server duet \
    && mkdir -p /out/usr/local/bin \
    && for program in duet-server duet; do \
         strip -o /out/usr/local/bin/$program build/release/bin/$program; \
       done

FROM build AS build-training
RUN --mount=type=cache,id=duet-ccache,target=/var/cache/ccache \
    cmake --build --preset release --parallel "$(scripts/build_jobs.sh)" \
    --target duet-train duet-eval duet-import \
    && cmake --install build/release --prefix /out/usr/local --strip --component training

# The server image's root, with only the packages' files, and its bill of materials.
FROM ${BASE} AS root
ARG VERSION=1.0.0
ARG SBOM_TIME=1970-01-01T00:00:00Z
WORKDIR /src
COPY packages/runtime.txt packages/image_root.txt packages/releases.tsv packages/
COPY scripts/install_packages.sh scripts/
RUN scripts/install_packages.sh runtime image_root && rm -rf /var/lib/apt/lists/*
COPY deploy/image/make_root.sh deploy/image/write_sbom.py deploy/image/
COPY LICENSE NOTICE ./
RUN deploy/image/make_root.sh /root-of-image $(scripts/install_packages.sh --print runtime) \
    && mkdir -p /root-of-image/usr/share/doc/duet \
    && cp LICENSE /root-of-image/usr/share/doc/duet/copyright \
    && cp NOTICE /root-of-image/usr/share/doc/duet/ \
    && deploy/image/write_sbom.py --version "$VERSION" --created "$SBOM_TIME" /root-of-image \
       >/duet.spdx.json \
    && mv /duet.spdx.json /root-of-image/usr/share/doc/duet/

# The training image's packages, and its bill of materials.
FROM ${BASE} AS training-packages
COPY packages/runtime.txt packages/training.txt packages/releases.tsv /tmp/install/packages/
COPY scripts/install_packages.sh /tmp/install/scripts/
RUN /tmp/install/scripts/install_packages.sh runtime training \
    && rm -rf /tmp/install /var/lib/apt/lists/* /var/cache/apt/* /var/log/apt /var/log/dpkg.log

FROM root AS training-records
ARG VERSION=1.0.0
ARG SBOM_TIME=1970-01-01T00:00:00Z
COPY --from=training-packages /var/lib/dpkg/status /records/var/lib/dpkg/status
COPY --from=training-packages /usr/share/doc /records/usr/share/doc
RUN deploy/image/write_sbom.py --version "$VERSION" --created "$SBOM_TIME" /records \
    >/duet.spdx.json

FROM training-packages AS training
COPY --from=training-records /duet.spdx.json /usr/share/doc/duet/
COPY LICENSE /usr/share/doc/duet/copyright
COPY NOTICE /usr/share/doc/duet/
# No setuid files.
RUN find / -xdev -type f -perm /6000 -exec chmod a-s {} +
COPY --from=build-training /out /
ARG VERSION=1.0.0
ARG REVISION=unknown
ARG SOURCE=unknown
ARG CREATED=1970-01-01T00:00:00Z
LABEL org.opencontainers.image.title="Duet, training and evaluation" \
      org.opencontainers.image.description="Trains and measures the networks that Duet serves" \
      org.opencontainers.image.version="$VERSION" \
      org.opencontainers.image.revision="$REVISION" \
      org.opencontainers.image.source="$SOURCE" \
      org.opencontainers.image.created="$CREATED" \
      org.opencontainers.image.licenses="Apache-2.0"
USER 65532:65532
WORKDIR /tmp
ENTRYPOINT ["duet-train"]

FROM scratch AS server
COPY --from=root /root-of-image /
COPY --from=build /out /
ARG VERSION=1.0.0
ARG REVISION=unknown
ARG SOURCE=unknown
ARG CREATED=1970-01-01T00:00:00Z
LABEL org.opencontainers.image.title="Duet" \
      org.opencontainers.image.description="Answers one character's motion with another's, over gRPC" \
      org.opencontainers.image.version="$VERSION" \
      org.opencontainers.image.revision="$REVISION" \
      org.opencontainers.image.source="$SOURCE" \
      org.opencontainers.image.created="$CREATED" \
      org.opencontainers.image.licenses="Apache-2.0"
ENV PATH=/usr/local/bin:/usr/bin
# A number, so that a cluster can verify that it is not root.
USER 65532:65532
# gRPC; Prometheus metrics.
EXPOSE 50051 9464
STOPSIGNAL SIGTERM
# Asks for /healthz, which needs neither certificates nor tokens. The server connects to its own port, so that it notices
# a listener without descriptors. Variables (DUET_SERVER_METRICS_LISTEN) apply to the check too; flags do not.
HEALTHCHECK --interval=10s --timeout=5s --start-period=30s --retries=3 \
    CMD ["duet-server", "--check-health"]
ENTRYPOINT ["duet-server"]
