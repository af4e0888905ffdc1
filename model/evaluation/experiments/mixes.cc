#include "model/evaluation/experiments/mixes.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <map>
#include <tuple>

#include "absl/strings/str_cat.h"
#include "model/base/statistics.h"
#include "model/evaluation/experiments/estimate.h"

namespace duet::evaluation::experiments {
namespace {

// A feature counts for a model whose single answers differ by at least this share of the captures'
// difference; below it, what a mix keeps is a ratio of noise.
constexpr double kLeastDifference = 0.3;
// What a mix keeps of one feature is limited to this range: no single feature decides the mean.
constexpr double kLeastKept = -0.5, kMostKept = 1.5;

int Likeliest(const std::vector<float>& probabilities) {
  return static_cast<int>(std::max_element(probabilities.begin(), probabilities.end()) -
                          probabilities.begin());
}

double AsNumber(bool yes) { return yes ? 1 : 0; }

double DistanceOf(const motion::Poses& a, const motion::Poses& b) {
  double sum = 0;
  for (size_t i = 0; i < a.all().size(); ++i) {
    const motion::Vec3 apart = a.all()[i] - b.all()[i];
    sum += double{Dot(apart, apart)};
  }
  return std::sqrt(sum);
}

// By how much single answers to the class of lower index exceed those to the other one, mean over
// all answers to the pair. Shapes: by pair, [features].
std::map<std::pair<int, int>, std::vector<double>> SingleDifferences(
    const std::vector<MixedAnswer>& answers) {
  std::map<std::pair<int, int>, std::vector<double>> sums;
  std::map<std::pair<int, int>, int> counts;
  for (const MixedAnswer& answer : answers) {
    const std::pair<int, int> pair = std::minmax(answer.own, answer.other);
    const double sign = answer.own < answer.other ? 1 : -1;
    std::vector<double>& sum = sums[pair];
    sum.resize(answer.mixed.size());
    for (size_t f = 0; f < sum.size(); ++f) {
      sum[f] += sign * (answer.own_alone[f] - answer.other_alone[f]);
    }
    ++counts[pair];
  }
  for (auto& [pair, sum] : sums) {
    for (double& value : sum) value /= counts[pair];
  }
  return sums;
}

// What remains of one class's own geometry, and of how many features.
std::pair<double, int> KeptOf(const MixedAnswer& answer, Ingredient which,
                              const ClassGeometry& captured, const std::vector<double>& single) {
  const bool is_own = which == Ingredient::kOwn;
  const int kept = is_own ? answer.own : answer.other, lost = is_own ? answer.other : answer.own;
  const std::vector<double>& without = is_own ? answer.other_alone : answer.own_alone;
  std::vector<double> shares;
  for (size_t f = 0; f < single.size(); ++f) {
    const double expected = captured.Own(kept, lost, f);
    const double difference = kept < lost ? single[f] : -single[f];
    if (expected == 0 || difference < kLeastDifference * expected) continue;
    shares.push_back(
        std::clamp((answer.mixed[f] - without[f]) / difference, kLeastKept, kMostKept));
  }
  return {base::Mean(shares), static_cast<int>(shares.size())};
}

struct MixFigure {
  const char* name;
  std::function<double(const MixedAnswer&, const Kept&)> of;
};

std::vector<MixFigure> MixFigures() {
  const auto probability = [](int c, const MixedAnswer& answer) {
    return double{answer.probabilities[static_cast<size_t>(c)]};
  };
  return {{"weaker ingredient", [](auto&, const Kept& kept) { return kept.weaker(); }},
          {"both above half", [](auto&, const Kept& kept) { return kept.both(); }},
          {"own ingredient", [](auto&, const Kept& kept) { return kept.own; }},
          {"other ingredient", [](auto&, const Kept& kept) { return kept.other; }},
          {"third class",
           [](const MixedAnswer& answer, auto&) {
             const int likeliest = Likeliest(answer.probabilities);
             return AsNumber(likeliest != answer.own && likeliest != answer.other);
           }},
          {"probability of own", [=](auto& a, auto&) { return probability(a.own, a); }},
          {"probability of other", [=](auto& a, auto&) { return probability(a.other, a); }},
          {"deviation from average", [](auto& a, auto&) { return a.deviation; }},
          {"twisted", [](auto& a, auto&) { return a.twisted; }},
          {"overlap", [](auto& a, auto&) { return a.overlapping; }},
          {"skate", [](auto& a, auto&) { return a.skating; }},
          {"move for a step of 0.1", [](auto& a, auto&) { return a.largest_move; }}};
}

std::vector<int> LeadersOf(const std::vector<MixedAnswer>& answers) {
  std::vector<int> leaders;
  for (const MixedAnswer& answer : answers) leaders.push_back(answer.leader);
  return leaders;
}

double LargestOf(const std::vector<MixedAnswer>& answers) {
  double largest = NAN;  // std::fmax ignores it
  for (const MixedAnswer& answer : answers) largest = std::fmax(largest, answer.largest_move);
  return largest;
}

// A row for each pair of classes of one variant.
report::Table PairTable(const std::string& title, const std::vector<std::string>& classes,
                        const MixVariant& variant, const std::vector<Kept>& kept) {
  report::Table table = EstimateTable(absl::StrCat(title, ", ", variant.first, ", by pair"),
                                      {"weaker", "both", "third", "deviation"});
  table.columns.insert(table.columns.end(), {"features of first", "of second"});
  std::map<std::pair<int, int>, std::vector<size_t>> rows;
  for (size_t i = 0; i < variant.second.size(); ++i) {
    rows[std::minmax(variant.second[i].own, variant.second[i].other)].push_back(i);
  }
  const std::vector<MixFigure> figures = MixFigures();
  for (const auto& [pair, indices] : rows) {
    std::vector<Estimate> estimates;
    for (const size_t f : {0, 1, 4, 7}) {
      std::vector<int> leaders;
      std::vector<double> values;
      for (const size_t i : indices) {
        leaders.push_back(variant.second[i].leader);
        values.push_back(figures[f].of(variant.second[i], kept[i]));
      }
      estimates.push_back(BootstrapMean(leaders, values));
    }
    AddEstimates(absl::StrCat(classes[static_cast<size_t>(pair.first)], " + ",
                              classes[static_cast<size_t>(pair.second)]),
                 estimates, &table);
    std::vector<double> first, second;
    for (const size_t i : indices) {
      const bool own_first = variant.second[i].own == pair.first;
      first.push_back(own_first ? kept[i].own_features : kept[i].other_features);
      second.push_back(own_first ? kept[i].other_features : kept[i].own_features);
    }
    table.rows.back().values.insert(table.rows.back().values.end(),
                                    {base::Mean(first), base::Mean(second)});
  }
  return table;
}

}  // namespace

double Deviation(const motion::Poses& mixed, const motion::Poses& own, const motion::Poses& other) {
  motion::Poses average = own;
  for (size_t i = 0; i < average.all().size(); ++i) {
    average.all()[i] = Lerp(own.all()[i], other.all()[i], 0.5f);
  }
  const double scale = DistanceOf(own, other) / 2;
  return Ratio(DistanceOf(mixed, average), scale);
}

double LargestMove(const motion::Poses& before, const motion::Poses& after) {
  double largest = 0;
  for (size_t i = 0; i < before.all().size(); ++i) {
    largest = std::max(largest, double{Distance(before.all()[i], after.all()[i])});
  }
  return largest;
}

double Kept::weaker() const {
  return std::isnan(own) || std::isnan(other) ? NAN : std::min(own, other);
}

double Kept::both() const { return std::isnan(weaker()) ? NAN : AsNumber(weaker() > 0.5); }

std::vector<Kept> MeasureKept(const std::vector<MixedAnswer>& answers,
                              const std::vector<ClassGeometry>& folds) {
  const auto differences = SingleDifferences(answers);
  std::vector<Kept> all;
  for (const MixedAnswer& answer : answers) {
    const std::vector<double>& single = differences.at(std::minmax(answer.own, answer.other));
    const ClassGeometry& captured = folds[static_cast<size_t>(answer.fold)];
    Kept kept;
    std::tie(kept.own, kept.own_features) = KeptOf(answer, Ingredient::kOwn, captured, single);
    std::tie(kept.other, kept.other_features) =
        KeptOf(answer, Ingredient::kOther, captured, single);
    all.push_back(kept);
  }
  return all;
}

std::vector<report::Table> MixTables(const std::string& title,
                                     const std::vector<std::string>& classes,
                                     const std::vector<ClassGeometry>& folds,
                                     const std::vector<MixVariant>& variants) {
  std::vector<std::string> names;
  std::vector<std::vector<Kept>> kept;
  for (const MixVariant& variant : variants) {
    names.push_back(variant.first);
    kept.push_back(MeasureKept(variant.second, folds));
  }
  std::vector<report::Table> tables = {EstimateTable(title, names)};
  for (const MixFigure& figure : MixFigures()) {
    std::vector<Estimate> estimates;
    for (size_t v = 0; v < variants.size(); ++v) {
      const std::vector<MixedAnswer>& answers = variants[v].second;
      std::vector<double> values;
      for (size_t i = 0; i < answers.size(); ++i) {
        values.push_back(figure.of(answers[i], kept[v][i]));
      }
      estimates.push_back(BootstrapMean(LeadersOf(answers), values));
    }
    AddEstimates(figure.name, estimates, &tables.front());
  }
  std::vector<Estimate> largest;
  for (const MixVariant& variant : variants) {
    largest.push_back({LargestOf(variant.second), NAN, NAN});
  }
  AddEstimates("largest of these moves", largest, &tables.front());
  tables.front().notes = {
      "Ingredients: how much of each class's own geometry the answer keeps, between the same "
      "leader's answer to the other class alone (0) and to this class alone (1). A class's own "
      "geometry: the features that are larger in its training captures than in the other class's, "
      "by more than their spread. Pairs in which a class has none do not count.",
      "Third class: share that the judge assigns to neither class. Deviation from average: 0 for "
      "the average of the two single answers, 1 for one of them. Twisted, overlap, skate: shares "
      "of frames. Move for a step of 0.1: the largest move of any joint in any frame when a "
      "weight moves by 0.1, metres, mean over the answers. One label: the own class alone.",
      "Low, high: 95 % interval by the bootstrap over leaders."};
  for (size_t v = 0; v < variants.size(); ++v) {
    tables.push_back(PairTable(title, classes, variants[v], kept[v]));
  }
  return tables;
}

namespace {

// A ratio of sums over the answers with these rows.
using AvoidFigure = std::function<double(const AvoidingAnswer&)>;
Statistic RatioOf(const std::vector<AvoidingAnswer>& answers, AvoidFigure figure,
                  AvoidFigure base) {
  return [&answers, figure = std::move(figure),
          base = std::move(base)](const std::vector<size_t>& rows) {
    double sum = 0, base_sum = 0;
    for (const size_t row : rows) {
      sum += figure(answers[row]);
      base_sum += base(answers[row]);
    }
    return Ratio(sum, base_sum);
  };
}

struct NamedStatistic {
  const char* name;
  AvoidFigure figure, base;
};

std::vector<NamedStatistic> AvoidStatistics() {
  const auto probability = [](const std::vector<float>& of, int c) {
    return double{of[static_cast<size_t>(c)]};
  };
  const auto one = [](const AvoidingAnswer&) { return 1.0; };
  return {
      {"requested, of alone",
       [=](const AvoidingAnswer& a) { return probability(a.avoiding, a.own); },
       [=](const AvoidingAnswer& a) { return probability(a.alone, a.own); }},
      {"recognised, of alone",
       [](const AvoidingAnswer& a) { return AsNumber(Likeliest(a.avoiding) == a.own); },
       [](const AvoidingAnswer& a) { return AsNumber(Likeliest(a.alone) == a.own); }},
      {"recognised alone",
       [](const AvoidingAnswer& a) { return AsNumber(Likeliest(a.alone) == a.own); }, one},
      {"avoided", [=](const AvoidingAnswer& a) { return probability(a.avoiding, a.avoided); }, one},
      {"avoided, alone", [=](const AvoidingAnswer& a) { return probability(a.alone, a.avoided); },
       one},
      {"distance moved", [](const AvoidingAnswer& a) { return std::abs(a.moved); }, one},
      {"farther", [](const AvoidingAnswer& a) { return a.moved; }, one}};
}

}  // namespace

std::vector<report::Table> AvoidTables(const std::string& title,
                                       const std::vector<std::string>& classes,
                                       const std::vector<AvoidingAnswer>& answers) {
  report::Table all = EstimateTable(title, {"own 1, other -1"});
  report::Table by_class{absl::StrCat(title, ", by requested class")};
  by_class.decimals = 3;
  std::vector<int> leaders;
  std::map<int, std::vector<size_t>> rows;
  for (size_t i = 0; i < answers.size(); ++i) {
    leaders.push_back(answers[i].leader);
    rows[answers[i].own].push_back(i);
  }
  for (const auto& [own, of_class] : rows) {
    by_class.rows.push_back({classes[static_cast<size_t>(own)], {}});
  }
  for (const NamedStatistic& named : AvoidStatistics()) {
    const Statistic statistic = RatioOf(answers, named.figure, named.base);
    AddEstimates(named.name, {Bootstrap(leaders, statistic)}, &all);
    by_class.columns.emplace_back(named.name);
    auto row = by_class.rows.begin();
    for (const auto& [own, of_class] : rows) row++->values.push_back(statistic(of_class));
  }
  all.notes = {
      "Requested, avoided: the judge's probability of the own class and of the class at -1; "
      "recognised: share of answers whose likeliest class is the own one; of alone: as a ratio to "
      "the own class at 1 by itself. Distance moved: by how much the mean distance of the roots "
      "differs from that answer's, metres; farther: with its sign."};
  return {std::move(all), std::move(by_class)};
}

}  // namespace duet::evaluation::experiments
