"""Real requests of every method that the server offers: what the fuzzer starts from.

The fuzzer asks the server by reflection what it serves, and fails for a method that has none here."""

import pathlib

from wire.protobuf import message

HEALTH = "grpc.health.v1.Health"
REFLECTION = "grpc.reflection.v1alpha.ServerReflection"
SYNTHESIS = "duet.v1.MotionSynthesis"
SYNTHESIZE = f"{SYNTHESIS}/Synthesize"
ADMIN = "duet.admin.v1.Admin"
# Methods whose answer has no end unless the client cancels the call.
ENDLESS = (f"{HEALTH}/Watch",)
# A model that exists in order to be loaded, unloaded and labelled. No request that changes anything
# names another one, so that good calls have the same answer throughout.
SPARE = "spare"


def requests_of_methods(source):
    """"service/method" -> its requests, the simplest first. `source`: the project's folder."""
    samples = pathlib.Path(source) / "tests/fuzz/corpus/synthesis_request"
    synthesize = [(samples / name).read_bytes() for name in ("sample", "options")]
    version, label = message(f1=SPARE, f2=1), message(f1=SPARE, f2="blue", f3=1)
    return {
        SYNTHESIZE: synthesize,
        # The fields that a LiveStart and a clip's request share have the same numbers.
        f"{SYNTHESIS}/SynthesizeLive": [message(f1=synthesize[0]), message(f2=message(f2=1))],
        f"{SYNTHESIS}/ListModels": [b""],
        f"{SYNTHESIS}/GetModel": [message(f1=message(f1="sbu", f2=2)),
                                  message(f1=message(f1=SPARE, f3="blue")), b""],
        f"{ADMIN}/ListModels": [b""],
        f"{ADMIN}/LoadModel": [version],
        f"{ADMIN}/UnloadModel": [version],
        f"{ADMIN}/Reload": [b""],
        f"{ADMIN}/SetLabel": [label],
        f"{ADMIN}/DeleteLabel": [message(f1=SPARE, f2="blue")],
        f"{HEALTH}/Check": [message(f1=SYNTHESIS), b""],
        f"{HEALTH}/Watch": [message(f1=SYNTHESIS), b""],
        f"{REFLECTION}/ServerReflectionInfo": [
            message(f7=""), message(f1="host", f3="duet/v1/synthesis.proto"),
            message(f4=f"{SYNTHESIS}.Synthesize"), message(f5=message(f1="duet.v1.Motion", f2=7)),
            message(f6="duet.v1.Motion")],
    }
