"""Python stubs of Duet's protos, made when this module is imported, for clients that share no code with ours. Skips the
test without gRPC for Python or its plugin of protoc."""

import shutil
import sys
import tempfile

import tools

try:
    import grpc
except ImportError as error:
    tools.skip(f"{error}; install the package python3-grpcio")
# Not grpc_tools.protoc: Debian 12's version is from 2018 and does not support `optional`.
PLUGIN = shutil.which("grpc_python_plugin")
if PLUGIN is None:
    tools.skip("no grpc_python_plugin; install the package protobuf-compiler-grpc")

_FOLDER = tempfile.TemporaryDirectory()  # pylint: disable=consider-using-with
tools.run("protoc", f"-I{tools.SOURCE / 'proto'}", f"--python_out={_FOLDER.name}", f"--grpc_python_out={_FOLDER.name}",
          f"--plugin=protoc-gen-grpc_python={PLUGIN}", "duet/v1/model.proto", "duet/v1/motion.proto",
          "duet/v1/reaction.proto", "duet/v1/live.proto", "duet/v1/synthesis.proto",
          "duet/rpc/v1/status.proto").check_returncode()
sys.path.insert(0, _FOLDER.name)

from duet.rpc.v1 import status_pb2  # noqa: E402
from duet.v1 import live_pb2, motion_pb2, synthesis_pb2, synthesis_pb2_grpc  # noqa: E402


def details_of(error):
    """The details of an RpcError: name of the message, such as "BadRequest", to the message."""
    trailers = dict(error.trailing_metadata() or ())
    status = status_pb2.Status.FromString(trailers.get("grpc-status-details-bin", b""))
    names = [(detail.type_url.rsplit(".", 1)[1], detail.value) for detail in status.details]
    return {name: getattr(status_pb2, name).FromString(value) for name, value in names}
