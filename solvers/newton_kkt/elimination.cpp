#include "tenon/solvers/newton_kkt/elimination.hpp"

#include <algorithm>
#include <numeric>

namespace tenon {
namespace {

struct EliminationTree {
  std::vector<int> parent;  // -1 at a root
  std::vector<int> count;   // entries of L below the diagonal of each column
};

// Row i of L is the part of the tree that its entries of K span, climbed towards i. Time: the entries of L.
EliminationTree elimination_tree(const Graph& graph, const std::vector<int>& order, const std::vector<int>& position) {
  const int size = graph.size();
  EliminationTree tree{std::vector<int>(size, -1), std::vector<int>(size, 0)};
  std::vector<int> mark(size, -1);
  for (int i = 0; i < size; ++i) {
    mark[i] = i;
    for (int k = graph.begin[order[i]]; k < graph.begin[order[i] + 1]; ++k) {
      for (int j = position[graph.neighbours[k]]; j < i && mark[j] != i; j = tree.parent[j]) {
        if (tree.parent[j] == -1) tree.parent[j] = i;
        ++tree.count[j];
        mark[j] = i;
      }
    }
  }
  return tree;
}

std::vector<int> inverse(const std::vector<int>& order) {
  std::vector<int> position(order.size());
  for (int k = 0; k < static_cast<int>(order.size()); ++k) position[order[k]] = k;
  return position;
}

// Vertices of a forest, children before parents, each subtree contiguous, siblings in ascending order.
std::vector<int> postorder(const std::vector<int>& parent) {
  const int size = static_cast<int>(parent.size());
  std::vector<int> head(size, -1), next(size, -1), stack, order;
  for (int v = size - 1; v >= 0; --v) {
    if (parent[v] != -1) next[v] = head[parent[v]], head[parent[v]] = v;
  }
  order.reserve(size);
  for (int root = 0; root < size; ++root) {
    if (parent[root] != -1) continue;
    stack.push_back(root);
    while (!stack.empty()) {
      const int v = stack.back();
      if (head[v] == -1) {
        order.push_back(v);
        stack.pop_back();
      } else {
        stack.push_back(head[v]);
        head[v] = next[head[v]];
      }
    }
  }
  return order;
}

// Columns that leave in one front. Columns with the same rows are one at once; a child joins its parent where the zeros that this
// stores are few, or the front is narrow anyway: wider fronts vectorise, and leave more choice of pivots.
struct Supernodes {
  std::vector<int> parent;                // -1 at a root
  std::vector<std::vector<int>> columns;  // ascending
};

bool worth_merging(int width, double zeros, double area) {
  return width <= 8 || (width <= 24 && zeros < 0.4 * area) || (width <= 64 && zeros < 0.1 * area) || zeros < 0.05 * area;
}

Supernodes merge_columns(const EliminationTree& tree) {
  const int size = static_cast<int>(tree.parent.size());
  std::vector<int> children(size, 0), into(size, -1), width(size, 1), height(size);
  std::vector<double> zeros(size, 0.0);
  for (int j = 0; j < size; ++j) {
    height[j] = tree.count[j];
    if (tree.parent[j] != -1) ++children[tree.parent[j]];
  }
  // Each supernode is named by its last column; columns come in postorder, children before parents.
  std::vector<std::vector<int>> merged_children(size);
  for (int j = 0; j < size; ++j) {
    std::vector<int>& candidates = merged_children[j];
    // the widest child first: it has most to gain
    std::sort(candidates.begin(), candidates.end(), [&](int a, int b) { return width[a] + height[a] > width[b] + height[b]; });
    for (int c : candidates) {
      const double total = width[c] + width[j];
      auto area = [](double w, double h) { return w * (w + 1) / 2 + w * h; };
      const double merged_area = area(total, height[j]);
      const double merged_zeros = merged_area - area(width[c], height[c]) - area(width[j], height[j]) + zeros[c] + zeros[j];
      if (merged_zeros == 0 || worth_merging(static_cast<int>(total), merged_zeros, merged_area)) {
        into[c] = j;
        width[j] = static_cast<int>(total);
        zeros[j] = merged_zeros;
      }
    }
    if (tree.parent[j] != -1) merged_children[tree.parent[j]].push_back(j);
  }

  Supernodes nodes;
  std::vector<int> name(size, -1);
  for (int j = size - 1; j >= 0; --j) {  // parents first: a merged column takes its parent's name
    if (into[j] != -1) {
      name[j] = name[into[j]];
      continue;
    }
    name[j] = static_cast<int>(nodes.parent.size());
    nodes.parent.push_back(tree.parent[j] == -1 ? -1 : name[tree.parent[j]]);
  }
  nodes.columns.resize(nodes.parent.size());
  for (int j = 0; j < size; ++j) nodes.columns[name[j]].push_back(j);
  return nodes;
}

// Rows of each front: those of its columns in K and those its children leave over.
void find_rows(const Graph& graph, FrontTree& tree) {
  std::vector<int> mark(tree.size, -1);
  tree.rows_begin = {0};
  for (int s = 0; s < tree.fronts(); ++s) {
    const auto begin = static_cast<std::ptrdiff_t>(tree.rows.size());
    auto add = [&](int i) {
      if (i >= tree.first[s + 1] && mark[i] != s) mark[i] = s, tree.rows.push_back(i);
    };
    for (int j = tree.first[s]; j < tree.first[s + 1]; ++j) {
      for (int k = graph.begin[tree.order[j]]; k < graph.begin[tree.order[j] + 1]; ++k) add(tree.position[graph.neighbours[k]]);
    }
    for (int c = tree.children_begin[s]; c < tree.children_begin[s + 1]; ++c) {
      const int child = tree.children[c];
      for (int k = tree.rows_begin[child]; k < tree.rows_begin[child + 1]; ++k) add(tree.rows[k]);
    }
    std::sort(tree.rows.begin() + begin, tree.rows.end());
    tree.rows_begin.push_back(static_cast<int>(tree.rows.size()));
  }
}

void find_places_in_parents(FrontTree& tree) {
  tree.in_parent.resize(tree.rows.size());
  for (int s = 0; s < tree.fronts(); ++s) {
    const int p = tree.parent[s];
    if (p == -1) continue;
    int row = tree.rows_begin[p];
    for (int k = tree.rows_begin[s]; k < tree.rows_begin[s + 1]; ++k) {
      if (tree.rows[k] < tree.first[p + 1]) {
        tree.in_parent[k] = tree.rows[k] - tree.first[p];
      } else {
        while (tree.rows[row] != tree.rows[k]) ++row;
        tree.in_parent[k] = tree.width(p) + row - tree.rows_begin[p];
      }
    }
  }
}

}  // namespace

Graph::Graph(const SparsePattern& lower) : begin(static_cast<std::size_t>(lower.cols) + 1, 0) {
  auto each_pair = [&](auto visit) {
    for (int j = 0; j < lower.cols; ++j) {
      for (int k = lower.outer[j]; k < lower.outer[j + 1]; ++k) {
        if (lower.inner[k] != j) visit(lower.inner[k], j);
      }
    }
  };
  each_pair([&](int i, int j) { ++begin[i + 1], ++begin[j + 1]; });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  neighbours.resize(begin.back());
  std::vector<int> next(begin.begin(), begin.end() - 1);
  each_pair([&](int i, int j) { neighbours[next[i]++] = j, neighbours[next[j]++] = i; });
}

double elimination_work(const Graph& graph, const std::vector<int>& order) {
  double work = 0;
  for (double count : elimination_tree(graph, order, inverse(order)).count) work += count * (count + 3) / 2;
  return work;
}

FrontTree make_front_tree(const Graph& graph, const std::vector<int>& order) {
  // the same elimination in postorder: columns that will share a front become neighbours
  std::vector<int> sorted;
  for (int k : postorder(elimination_tree(graph, order, inverse(order)).parent)) sorted.push_back(order[k]);
  const Supernodes nodes = merge_columns(elimination_tree(graph, sorted, inverse(sorted)));

  FrontTree tree;
  tree.size = graph.size();
  tree.first = {0};
  const std::vector<int> fronts = postorder(nodes.parent);
  const std::vector<int> name = inverse(fronts);
  for (int node : fronts) {
    tree.parent.push_back(nodes.parent[node] == -1 ? -1 : name[nodes.parent[node]]);
    for (int column : nodes.columns[node]) tree.order.push_back(sorted[column]);
    tree.first.push_back(static_cast<int>(tree.order.size()));
  }
  tree.position = inverse(tree.order);

  tree.depth.assign(fronts.size(), 0);
  tree.children_begin.assign(fronts.size() + 1, 0);
  for (int s = tree.fronts() - 1; s >= 0; --s) {
    if (tree.parent[s] == -1) continue;
    tree.depth[s] = tree.depth[tree.parent[s]] + 1;
    ++tree.children_begin[tree.parent[s] + 1];
  }
  std::partial_sum(tree.children_begin.begin(), tree.children_begin.end(), tree.children_begin.begin());
  tree.children.resize(tree.children_begin.back());
  std::vector<int> next(tree.children_begin.begin(), tree.children_begin.end() - 1);
  for (int s = 0; s < tree.fronts(); ++s) {
    if (tree.parent[s] != -1) tree.children[next[tree.parent[s]]++] = s;
  }
  find_rows(graph, tree);
  find_places_in_parents(tree);
  return tree;
}

}  // namespace tenon
