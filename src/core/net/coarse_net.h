#pragma once

#include <array>
#include <vector>

#include "geometry/vector_array.h"
#include "verlet_cable/core/net.h"

namespace verlet_cable {

/// A grid's links on a grid of fewer nodes, each for several: a few sweeps over these carry over the whole net what would take
/// many sweeps over its own links (a two-grid correction: Brandt, Multi-Level Adaptive Solutions to Boundary-Value Problems,
/// 1977). What is carried are the links' impulses, interpolated, not velocities: momentum and angular momentum are kept.
class CoarseNet {
 public:
  /// `inverse_mass` [1/kg] by node, 0 where held. `softening` [kg]: impulse that a link loses for each m/s that its nodes part.
  void resize(const NetModel& model, const std::vector<double>& inverse_mass, double softening);
  /// `impulses` [N s] by link: what each lacks at present. Replaced by what is to be added to each link.
  void correct(const VectorArray& position, std::vector<double>& impulses);

 private:
  /// How samples along one direction of the grid make coarse ones: sample i has the part `lower` of `first` and `upper` of the
  /// next.
  struct Axis {
    std::vector<int> first;
    std::vector<double> lower, upper;
    Axis() = default;
    Axis(int samples, int coarse, double ratio, bool between_nodes);
    int samples() const { return static_cast<int>(first.size()); }
  };
  /// Links of one direction: horizontal, vertical, and the two diagonals.
  struct Direction {
    int rows = 0, columns = 0;                ///< of coarse links
    int first_offset = 0, second_offset = 0;  ///< of a coarse link's nodes from its row and column
    double series = 1;                        ///< links that one coarse link is as long as
    double length = 1;                        ///< [m] of a coarse link at rest
    Axis row_axis, column_axis;
    std::vector<double> weight;           ///< coarse link: links that it stands for
    std::vector<double> lacking;          ///< coarse link: [N s]
    std::vector<double> impulse;          ///< coarse link: [N s]
    std::vector<double> whole_softening;  ///< coarse link: [kg] where it is taut
    std::vector<double> part;             ///< coarse link: of it, what takes part in the step
    std::vector<double> softening;        ///< coarse link: [kg]
    std::vector<double> mobility;         ///< coarse link: 1 / (1 + softening e.e (w_i + w_j))
    VectorArray along;                    ///< coarse link: mean direction of its links
    std::vector<double> strip;            ///< rows of coarse links by columns of links
  };
  /// Links side by side in the model and in the grid.
  struct Piece {
    int direction, row, column, link, count;
  };

  void add_pieces(const NetModel& model);
  void add_weights(double softening);
  void add_nodes(const NetModel& model, const std::vector<double>& inverse_mass);
  void aim(const VectorArray& position);
  void gather(const std::vector<double>& impulses);
  void sweep(bool forwards);
  void spread(std::vector<double>& impulses);

  int fine_rows_ = 0, fine_columns_ = 0, rows_ = 0, columns_ = 0;
  double row_ratio_ = 1, column_ratio_ = 1;  ///< links of the grid on the way from one coarse node to the next
  std::vector<Piece> pieces_;
  std::array<Direction, 4> directions_;
  std::vector<double> inverse_mass_;  ///< coarse node: [1/kg]
  VectorArray position_, velocity_;   ///< coarse node
};

}  // namespace verlet_cable
