// The module duet_motion._motion_files. duet_motion/_motion_files.pyi describes it to Python.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/python/extension/motion_files.h"
#include "model/motion/clip.h"
#include "model/motion/vertical.h"
#include "model/retargeting/joint_mapping.h"

namespace duet::client::python::extension {
namespace {

namespace py = pybind11;

// Raises `type`. A file name in the message may not be UTF-8.
[[noreturn]] void Raise(const py::object& type, const absl::Status& error) {
  const std::string text = DescribeError(error);
  const auto message = py::reinterpret_steal<py::object>(
      PyUnicode_DecodeUTF8(text.data(), static_cast<py::ssize_t>(text.size()), "replace"));
  if (message) PyErr_SetObject(type.ptr(), message.ptr());
  throw py::error_already_set();
}

// Exposes the positions without a copy: the array keeps the clip alive. They are read-only.
py::buffer_info PositionsOf(motion::Clip& clip) {
  constexpr py::ssize_t kAxes = 3, kFloat = sizeof(float);
  const py::ssize_t frames = clip.frame_count(), joints = clip.joint_count();
  return {&clip.at(0, 0).x,
          {frames, joints, kAxes},
          {joints * kAxes * kFloat, kAxes * kFloat, kFloat},
          /*readonly=*/true};
}

// With the names of `duet inspect --json`.
py::dict ToDict(const motion::VerticalEstimate& estimate) {
  py::dict values;
  values["verdict"] = std::string(VerdictName(estimate.verdict));
  values["text"] = Describe(estimate);
  values["up"] = std::vector<float>{estimate.up.x, estimate.up.y, estimate.up.z};
  values["tilt_degrees"] = estimate.tilt_degrees;
  values["error_degrees"] = estimate.error_degrees;
  values["deviations"] = estimate.deviations;
  values["disagreement"] = estimate.disagreement;
  values["places"] = estimate.places;
  return values;
}

PYBIND11_MODULE(_motion_files, module) {
  module.doc() =
      "Reads and writes motion files, and estimates the vertical of their camera; see "
      "duet_motion.files.";
  const py::object error = py::exception<absl::Status>(module, "Error");

  py::class_<motion::Clip>(module, "Person", py::buffer_protocol())
      .def_buffer(&PositionsOf)
      .def_property_readonly("positions",
                             [](const py::object& clip) { return py::memoryview(clip); })
      .def_property_readonly("joint_names",
                             [](const motion::Clip& clip) { return clip.joint_names; })
      .def_readonly("frame_rate_hz", &motion::Clip::frame_rate_hz);

  module.def(
      "read",
      [error](const std::filesystem::path& path, const std::string& side,
              std::optional<double> frame_rate_hz, const std::string& unit,
              const std::string& up_axis, std::optional<double> metres_per_unit,
              const retargeting::JointOverrides& joint_map, std::optional<double> resample_hz,
              const std::string& layout, const std::string& body_model) {
        absl::StatusOr<std::vector<motion::Clip>> people;
        {
          const py::gil_scoped_release release;
          people = ReadMotion(path, {side, frame_rate_hz, unit, up_axis, metres_per_unit, joint_map,
                                     resample_hz, layout, body_model});
        }
        if (!people.ok()) Raise(error, people.status());
        return *std::move(people);
      },
      py::arg("path"), py::kw_only(), py::arg("side"), py::arg("frame_rate_hz"), py::arg("unit"),
      py::arg("up_axis"), py::arg("metres_per_unit"), py::arg("joint_map"), py::arg("resample_hz"),
      py::arg("layout") = "", py::arg("body_model") = "");

  module.def(
      "write",
      [error](const std::string& document, const std::filesystem::path& path) {
        absl::Status written;
        {
          const py::gil_scoped_release release;
          written = WriteMotion(document, path);
        }
        if (!written.ok()) Raise(error, written);
      },
      py::arg("document"), py::arg("path"));

  module.def(
      "estimate_vertical",
      [error](const std::vector<std::string>& documents) {
        absl::StatusOr<motion::VerticalEstimate> estimate;
        {
          const py::gil_scoped_release release;
          estimate = EstimateVertical(documents);
        }
        if (!estimate.ok()) Raise(error, estimate.status());
        return ToDict(*estimate);
      },
      py::arg("documents"));
}

}  // namespace
}  // namespace duet::client::python::extension
