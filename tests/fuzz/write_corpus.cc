// Writes those inputs of the corpora that are not written by hand, by the project's own writers:
//   write_corpus tests/fuzz/corpus
// The same files each time.
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "model/checkpoint/checkpoint.h"
#include "model/checkpoint/safetensors.h"
#include "model/formats/flat/flat_files.h"
#include "model/formats/motion_file.h"
#include "model/motion/skeleton.h"
#include "tests/formats/gltf/gltf_fixture.h"
#include "tests/server/support/sample_request.h"
#include "tests/support/architectures.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_motion.h"
#include "tests/support/tiny_checkpoint.h"

namespace duet::fuzz {
namespace {

namespace fs = std::filesystem;
using formats::Format;

motion::Clip Person() {
  test::PersonOptions options;
  options.frames = 2;
  return test::MakePerson(options);
}

class Corpus {
 public:
  explicit Corpus(fs::path folder) : folder_(std::move(folder)) {}

  void WriteMotions() const {
    const motion::Skeleton skeleton = motion::SbuSkeleton();
    const motion::Clip person = Person();
    Write("bvh/person.bvh", *FormatPeople(Format::kBvh, {person}, skeleton));
    Write("csv/pair.csv", *FormatPeople(Format::kCsv, {person, person}, skeleton));
    Write("json_motion/pair.json", *FormatPeople(Format::kJson, {person, person}, skeleton));
    Write("npy/pair.npy", *FormatPeople(Format::kNpy, {person, person}, skeleton));
    Write("npy/person.npy", *FormatPeople(Format::kNpy, {person}, skeleton));
    Write("sbu_text/pair.txt", *formats::flat::FormatSbu({person, person}));
  }

  void WriteGltf() const {
    test::GltfPersonOptions spline;
    spline.interpolation = "CUBICSPLINE";
    spline.centimetres_below_an_armature = true;
    test::GltfBuilder builder;
    AddPerson(Person(), spline, &builder);
    Write("gltf/armature.gltf", builder.WithDataUri());
    test::GltfBuilder skinned;
    AddPerson(Person(), {}, &skinned);
    Write("gltf/skin.glb", skinned.Binary());
    test::GltfPersonOptions bare;
    bare.interpolation = "STEP";
    bare.with_skin = false;
    test::GltfBuilder binary;
    AddPerson(Person(), bare, &binary);
    Write("gltf/step.glb", binary.Binary());
  }

  void WriteCheckpoints() const {
    checkpoint::Checkpoint tiny = test::TinyCheckpoint();
    const std::string weights = SerializeSafetensors(tiny.tensors, {{"format", "pt"}});
    tiny.manifest.weights.bytes = weights.size();
    tiny.manifest.weights.sha256 = std::string(64, '0');
    Write("checkpoint/tiny", SerializeManifest(tiny.manifest) + '\0' + weights);
    tiny.manifest.architecture = test::SmallFlow();
    Write("checkpoint/flow", SerializeManifest(tiny.manifest) + '\0' + weights.substr(0, 64));
    tiny.tensors.resize(3);
    Write("safetensors/three", SerializeSafetensors(tiny.tensors, {{"format", "pt"}}));
  }

  void WriteRequest() const {
    v1::SynthesizeRequest request = test::SampleRequest(2);
    Write("synthesis_request/sample", request.SerializeAsString());
    request.set_seed(7);
    request.set_variety(0.5f);
    request.set_chunk_frames(1);
    request.mutable_follower_start()->mutable_root_position()->set_z(1);
    request.mutable_partner_direction()->set_x(1);
    request.add_reply_joint_names("head");
    v1::JointConstraint& constraint = *request.add_constraints();
    constraint.set_joint_name("right_hand");
    constraint.set_frame(1);
    constraint.mutable_position()->set_y(1);
    constraint.set_softness(0.5f);
    Write("synthesis_request/options", request.SerializeAsString());
  }

 private:
  void Write(const char* name, std::string_view content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
  }

  fs::path folder_;
};

}  // namespace
}  // namespace duet::fuzz

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: write_corpus CORPUS_FOLDER\n", stderr);
    return 2;
  }
  const duet::fuzz::Corpus corpus(argv[1]);
  corpus.WriteMotions();
  corpus.WriteGltf();
  corpus.WriteCheckpoints();
  corpus.WriteRequest();
  return 0;
}
