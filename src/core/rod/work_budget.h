#pragma once

#include <cstddef>

namespace verlet_cable {

/// Who waits for a step does not wait longer than a budget of work. It counts visits of a segment by an iteration that solves
/// nothing but tension and bending, each about 50 ns, and no time: the same on every machine.
namespace budget {
/// Of all islands together that the first share was not enough for, by their sizes.
constexpr double most = 5e5;
/// Of every island: iterations, of its size. Few steps take more.
constexpr double first_share = 40;
/// Likewise of the last attempt of a step that has used up its budget. With 500 cables in one place it takes five sixths of that.
constexpr double last_share = 500;
constexpr double heavy = 6;     ///< times as long take twist, contacts and bodies
constexpr double coupling = 2;  ///< likewise, a step that couples cables which touch each other
constexpr double touch = 1;     ///< counts as so many segments where contacts are visited
constexpr double guide = 0.3;   ///< so much longer takes each guide, whose flow all of a cable responds to
constexpr double cable = 4;     ///< counts as so many segments, beside those that it has
constexpr double body = 100;    ///< likewise
/// Of every net of limited or rigid links, of its size; all of them share `most` beyond that.
constexpr double net_first_share = 16;
constexpr double net = 100;              ///< counts as so many links, beside those that it has
constexpr double link_part = 0.5;        ///< for each part of a step, of every link
constexpr double link_sweep = 0.15;      ///< for each sweep over it
constexpr double link_look = 0.3;        ///< when it may be outside its bounds
constexpr double link_correction = 1.2;  ///< when it is
}  // namespace budget

/// Of an iteration that solves nothing but tension and bending, and the flows through so many guides.
inline double visiting_work(int segments, double guides) {
  return (1 + budget::guide * guides) * (budget::cable + segments);
}

/// The work of a solver, up to what it may take.
struct WorkCount {
  double size = 0;   ///< of visiting all that it solves once
  double spent = 0;  ///< so far
  double most = 0;

  void spend(double visits, std::size_t contacts) { spent += visits * size + budget::touch * static_cast<double>(contacts); }
  bool is_left() const { return spent < most; }
};

}  // namespace verlet_cable
