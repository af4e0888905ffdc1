#include "model/network/lstm.h"

#include <gtest/gtest.h>
#include <torch/torch.h>

namespace duet::network {
namespace {

constexpr int64_t kSteps = 5, kGroups = 2, kBatch = 3, kHidden = 4;

struct Problem {
  torch::Tensor gates, weight, hidden, cell, toward_hidden, toward_cell;
};

Problem MakeProblem(torch::ScalarType type) {
  torch::manual_seed(1);
  const auto wants_grad = torch::dtype(type).requires_grad(true);
  return {torch::randn({kSteps, kGroups, kBatch, 4 * kHidden}, wants_grad),
          torch::randn({kGroups, 4 * kHidden, kHidden}, wants_grad),
          torch::randn({kGroups, kBatch, kHidden}, wants_grad),
          torch::randn({kGroups, kBatch, kHidden}, wants_grad),
          torch::randn({kSteps, kGroups, kBatch, kHidden}, torch::dtype(type)),
          torch::randn({kSteps, kGroups, kBatch, kHidden}, torch::dtype(type))};
}

// The textbook recurrence in plain tensor operations.
std::pair<torch::Tensor, torch::Tensor> Textbook(const Problem& p) {
  torch::Tensor hidden = p.hidden, cell = p.cell;
  std::vector<torch::Tensor> hiddens, cells;
  for (int64_t t = 0; t < kSteps; ++t) {
    const auto gates = (p.gates[t] + torch::bmm(hidden, p.weight.transpose(1, 2))).chunk(4, -1);
    cell = gates[1].sigmoid() * cell + gates[0].sigmoid() * gates[2].tanh();
    hidden = gates[3].sigmoid() * cell.tanh();
    hiddens.push_back(hidden);
    cells.push_back(cell);
  }
  return {torch::stack(hiddens), torch::stack(cells)};
}

std::vector<torch::Tensor> Gradients(const Problem& p,
                                     const std::pair<torch::Tensor, torch::Tensor>& out) {
  const torch::Tensor loss =
      (out.first * p.toward_hidden).sum() + (out.second * p.toward_cell).sum();
  return torch::autograd::grad({loss}, {p.gates, p.weight, p.hidden, p.cell});
}

TEST(LstmSequenceTest, EqualsTheTextbookRecurrence) {
  const Problem p = MakeProblem(torch::kFloat64);
  const auto ours = LstmSequence(p.gates, p.weight, p.hidden, p.cell);
  const auto expected = Textbook(p);
  EXPECT_TRUE(torch::allclose(ours.first, expected.first, 1e-12, 1e-12));
  EXPECT_TRUE(torch::allclose(ours.second, expected.second, 1e-12, 1e-12));
}

TEST(LstmSequenceTest, GradientsEqualAutomaticOnes) {
  const Problem p = MakeProblem(torch::kFloat64);
  const auto ours = Gradients(p, LstmSequence(p.gates, p.weight, p.hidden, p.cell));
  const auto expected = Gradients(p, Textbook(p));
  for (size_t i = 0; i < expected.size(); ++i) {
    EXPECT_TRUE(torch::allclose(ours[i], expected[i], 1e-10, 1e-12)) << "input " << i;
  }
}

TEST(LstmSequenceTest, FloatKernelsAreAccurate) {
  const Problem p = MakeProblem(torch::kFloat32);
  const auto ours = LstmSequence(p.gates, p.weight, p.hidden, p.cell);
  const auto expected = Textbook(p);
  EXPECT_LT((ours.first - expected.first).abs().max().item<float>(), 2e-6);
  const auto gradients = Gradients(p, ours), wanted = Gradients(p, expected);
  for (size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_TRUE(torch::allclose(gradients[i], wanted[i], 1e-4, 1e-5)) << "input " << i;
  }
}

}  // namespace
}  // namespace duet::network
