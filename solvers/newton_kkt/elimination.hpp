// The order of elimination and what follows from it alone: the tree of fronts of a sparse symmetric matrix.
//
//                 +---- w own columns ----+---- R rows ----+
//     front s  =  | fully summed          |                |     w own columns leave here; what they change among the R rows below is the
//                 |                       | contribution   |     contribution, handed to the parent front
//                 +-----------------------+----------------+
//
// Sources: Liu, SIAM J. Matrix Anal. Appl. 11 (1990) 134 (elimination trees); Duff, Reid, ACM TOMS 9 (1983) 302 (multifrontal method);
// Ashcraft, Grimes, ACM TOMS 15 (1989) 291 (amalgamation). Equations: linear_algebra.md section 3.
#pragma once

#include <vector>

#include "tenon/core/sparse_pattern.hpp"

namespace tenon {

struct FrontTree {
  int size = 0;
  std::vector<int> order;     // size: the row of K eliminated at each position
  std::vector<int> position;  // size: its inverse
  std::vector<int> first;     // fronts + 1: front s owns the positions first[s] .. first[s+1]-1; children come before parents
  std::vector<int> parent;    // fronts: -1 at a root
  std::vector<int> depth;     // fronts: 0 at a root
  std::vector<int> children_begin, children;  // front s has the children children[children_begin[s]] .. children[children_begin[s+1]-1]
  std::vector<int> rows_begin, rows;          // positions of the R rows of each front, ascending
  std::vector<int> in_parent;                 // for each of `rows`: its place in the parent's front (0 .. w+R-1 there)

  int fronts() const { return static_cast<int>(parent.size()); }
  int width(int s) const { return first[s + 1] - first[s]; }
  int height(int s) const { return rows_begin[s + 1] - rows_begin[s]; }
};

/// Both triangles of a symmetric pattern without its diagonal, from its lower triangle.
struct Graph {
  std::vector<int> begin, neighbours;

  explicit Graph(const SparsePattern& lower);
  int size() const { return static_cast<int>(begin.size()) - 1; }
};

/// Order in which to eliminate K, n variables then m rows: minimum degree on the graph in which each row is tied to a variable of its own,
/// so that the two can leave together as one 2 x 2 pivot; or on the graph of K where that is very much sparser.
std::vector<int> order_kkt(const Graph& graph, int n);

/// Multiplications that a factorisation in this order takes.
double elimination_work(const Graph& graph, const std::vector<int>& order);

/// The tree for this order; positions are renumbered so that each front's columns are neighbours and children precede parents.
FrontTree make_front_tree(const Graph& graph, const std::vector<int>& order);

}  // namespace tenon
