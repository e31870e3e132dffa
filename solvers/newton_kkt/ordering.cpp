// Order of elimination for a KKT matrix: rows tied to variables, then approximate minimum degree.
//
//     [ h  a ]   is a good pivot whenever a is not small, even where h = 0; the row alone, [ 0 ], never is one.
//     [ a  0 ]
//
// Source of the minimum degree: Amestoy, Davis, Duff, SIAM J. Matrix Anal. Appl. 17 (1996) 886, as implemented in Eigen.
// Tied pairs: Duff, Pralet, SIAM J. Matrix Anal. Appl. 27 (2005) 313. Equations: linear_algebra.md section 3.
#include "tenon/solvers/newton_kkt/elimination.hpp"

#include <algorithm>
#include <numeric>

#include <Eigen/OrderingMethods>

namespace tenon {
namespace {

// Where untied minimum degree takes less than this share of the work, the delays it will cost are worth it.
constexpr double kUntiedShare = 0.25;

// partner[i] is the variable tied to row i or -1: rows with few choices choose first, and take a variable with few neighbours.
std::vector<int> tie_rows(const Graph& graph, int n) {
  const int size = graph.size();
  auto degree = [&](int i) { return graph.begin[i + 1] - graph.begin[i]; };
  std::vector<int> rows(size - n);
  std::iota(rows.begin(), rows.end(), n);
  std::stable_sort(rows.begin(), rows.end(), [&](int i, int j) { return degree(i) < degree(j); });
  std::vector<int> partner(size, -1);
  for (int i : rows) {
    int best = -1;
    for (int k = graph.begin[i]; k < graph.begin[i + 1]; ++k) {
      const int j = graph.neighbours[k];
      if (partner[j] == -1 && (best == -1 || degree(j) < degree(best))) best = j;
    }
    if (best != -1) partner[i] = best, partner[best] = i;
  }
  return partner;
}

// Minimum degree on the graph whose vertices are the groups; a group's members leave together, in ascending order.
std::vector<int> minimum_degree(const Graph& graph, const std::vector<int>& group, int groups) {
  std::vector<Eigen::Triplet<char>> entries;
  for (int i = 0; i < graph.size(); ++i) {
    entries.emplace_back(group[i], group[i], 1);
    for (int k = graph.begin[i]; k < graph.begin[i + 1]; ++k) {
      if (group[graph.neighbours[k]] != group[i]) entries.emplace_back(group[graph.neighbours[k]], group[i], 1);
    }
  }
  Eigen::SparseMatrix<char, Eigen::ColMajor, int> pattern(groups, groups);
  pattern.setFromTriplets(entries.begin(), entries.end(), [](char a, char) { return a; });
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation;
  Eigen::AMDOrdering<int>()(pattern, permutation);

  std::vector<std::vector<int>> members(groups);
  for (int i = 0; i < graph.size(); ++i) members[group[i]].push_back(i);
  std::vector<int> order;
  order.reserve(graph.size());
  for (int g : permutation.indices()) order.insert(order.end(), members[g].begin(), members[g].end());
  return order;
}

}  // namespace

std::vector<int> order_kkt(const Graph& graph, int n) {
  const int size = graph.size();
  std::vector<int> single(size);
  std::iota(single.begin(), single.end(), 0);
  std::vector<int> untied = minimum_degree(graph, single, size);
  if (n == size) return untied;

  const std::vector<int> partner = tie_rows(graph, n);
  std::vector<int> group(size, -1);
  int groups = 0;
  for (int i = 0; i < size; ++i) group[i] = partner[i] != -1 && partner[i] < i ? group[partner[i]] : groups++;
  std::vector<int> tied = minimum_degree(graph, group, groups);
  return elimination_work(graph, untied) < kUntiedShare * elimination_work(graph, tied) ? untied : tied;
}

}  // namespace tenon
