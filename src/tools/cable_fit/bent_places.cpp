#include "bent_places.h"

#include <utility>

namespace verlet_cable::cable_fit {

std::vector<double> places_along(const std::vector<double>& places, const std::vector<double>& predicted_places,
                                 const std::vector<Prediction>& predictions) {
  std::vector<double> along{0};
  for (std::size_t marker = 1; marker < places.size(); ++marker) {
    std::vector<double> chords;
    for (const Prediction& prediction : predictions)
      for (const std::vector<Vector3>& row : prediction.positions) chords.push_back((row[marker] - row[marker - 1]).norm());
    const double arc = predicted_places[marker] - predicted_places[marker - 1], chord = median(std::move(chords));
    along.push_back(along.back() + (places[marker] - places[marker - 1]) * (chord > 0 ? arc / chord : 1));
  }
  for (double& place : along) place /= along.back();
  return along;
}

}  // namespace verlet_cable::cable_fit
