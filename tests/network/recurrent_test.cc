#include "model/network/recurrent.h"

#include <gtest/gtest.h>
#include <torch/torch.h>

namespace duet::network {

namespace lstm {
namespace {

constexpr int64_t kSteps = 5, kGroups = 2, kBatch = 3, kHidden = 4;

struct Problem {
  torch::Tensor gates, weight, hidden, cell, toward_hidden, toward_cell;
};

Problem MakeProblem() {
  torch::manual_seed(1);
  const auto wants_grad = torch::requires_grad();
  return {torch::randn({kSteps, kGroups, kBatch, 4 * kHidden}, wants_grad),
          torch::randn({kGroups, 4 * kHidden, kHidden}, wants_grad),
          torch::randn({kGroups, kBatch, kHidden}, wants_grad),
          torch::randn({kGroups, kBatch, kHidden}, wants_grad),
          torch::randn({kSteps, kGroups, kBatch, kHidden}),
          torch::randn({kSteps, kGroups, kBatch, kHidden})};
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

TEST(LstmSequenceTest, ValuesAndGradientsEqualTheTextbookRecurrence) {
  const Problem p = MakeProblem();
  const auto ours = LstmSequence(p.gates, p.weight, p.hidden, p.cell), expected = Textbook(p);
  EXPECT_LT((ours.first - expected.first).abs().max().item<float>(), 2e-6);
  EXPECT_LT((ours.second - expected.second).abs().max().item<float>(), 2e-6);
  const auto gradients = Gradients(p, ours), wanted = Gradients(p, expected);
  for (size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_TRUE(torch::allclose(gradients[i], wanted[i], 1e-4, 1e-5)) << "input " << i;
  }
}

}  // namespace
}  // namespace lstm

namespace decoder {
namespace {

constexpr int64_t kGroups = 2, kBatch = 3, kFrames = 6, kAttention = 19, kHidden = 4, kEncoded = 5;

// The decoder as in Eq. 2 and 3.
struct Problem {
  torch::Tensor encoded;  // h [N, T, E]
  torch::Tensor u, v, w1, weight_ih, weight_hh, bias, hidden, cell;
  torch::Tensor lengths, toward;

  std::vector<torch::Tensor> Inputs() const {
    return {encoded, u, v, w1, weight_ih, weight_hh, bias, hidden, cell};
  }
};

Problem MakeProblem() {
  torch::manual_seed(2);
  const auto o = torch::requires_grad();
  Problem p;
  p.encoded = torch::randn({kBatch, kFrames, kEncoded}, o);
  p.u = torch::randn({kGroups, kAttention, kEncoded}, o);
  p.v = torch::randn({kGroups, kAttention, kHidden}, o);
  p.w1 = torch::randn({kGroups, kAttention}, o);
  p.weight_ih = torch::randn({kGroups, 4 * kHidden, kEncoded}, o);
  p.weight_hh = torch::randn({kGroups, 4 * kHidden, kHidden}, o);
  p.bias = torch::randn({kGroups, 4 * kHidden}, o);
  p.hidden = torch::randn({kGroups, kBatch, kHidden}, o);
  p.cell = torch::randn({kGroups, kBatch, kHidden}, o);
  p.lengths = torch::tensor({6, 4, 1}, torch::kInt64);
  p.toward = torch::randn({kFrames, kGroups, kBatch, kHidden});
  return p;
}

torch::Tensor Textbook(const Problem& p) {
  const torch::Tensor valid = FrameMask(p.lengths, kFrames).t();  // [N, T]
  std::vector<torch::Tensor> directions;
  for (int64_t g = 0; g < kGroups; ++g) {
    torch::Tensor hidden = p.hidden[g], cell = p.cell[g];
    std::vector<torch::Tensor> steps;
    for (int64_t t = 0; t < kFrames; ++t) {
      const torch::Tensor query = torch::matmul(hidden, p.v[g].t()).unsqueeze(1);
      const torch::Tensor energy =
          torch::matmul((torch::matmul(p.encoded, p.u[g].t()) + query).tanh(), p.w1[g]);
      const torch::Tensor phi = energy.masked_fill(~valid, -1e30).softmax(1);
      const torch::Tensor context = (phi.unsqueeze(2) * p.encoded).sum(1);
      const auto gates = (torch::matmul(context, p.weight_ih[g].t()) +
                          torch::matmul(hidden, p.weight_hh[g].t()) + p.bias[g])
                             .chunk(4, -1);
      cell = gates[1].sigmoid() * cell + gates[0].sigmoid() * gates[2].tanh();
      hidden = gates[3].sigmoid() * cell.tanh();
      steps.push_back(hidden);
    }
    directions.push_back(torch::stack(steps));
  }
  return torch::stack(directions, 1);
}

torch::Tensor Ours(const Problem& p) {
  const torch::Tensor h = p.encoded.unsqueeze(0);
  const auto project = [&](const torch::Tensor& weights) {
    return torch::matmul(h, weights.transpose(1, 2).unsqueeze(1));
  };
  return AttentiveDecoder({project(p.u), project(p.weight_ih) + p.bias.view({kGroups, 1, 1, -1}),
                           p.weight_hh, p.v, p.w1, p.hidden, p.cell, p.lengths});
}

TEST(AttentiveDecoderTest, ValuesAndGradientsEqualEquations2And3) {
  const Problem p = MakeProblem();
  const torch::Tensor ours = Ours(p), expected = Textbook(p);
  EXPECT_LT((ours - expected).abs().max().item<float>(), 5e-6);
  const auto gradients = torch::autograd::grad({(ours * p.toward).sum()}, p.Inputs());
  const auto wanted = torch::autograd::grad({(expected * p.toward).sum()}, p.Inputs());
  for (size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_TRUE(torch::allclose(gradients[i], wanted[i], 1e-4, 2e-5)) << "input " << i;
  }
}

TEST(AttentiveDecoderTest, InferenceEqualsTraining) {
  const Problem p = MakeProblem();
  const torch::Tensor training = Ours(p);
  torch::NoGradGuard no_grad;
  EXPECT_TRUE(torch::equal(Ours(p), training));
}

}  // namespace
}  // namespace decoder

}  // namespace duet::network
