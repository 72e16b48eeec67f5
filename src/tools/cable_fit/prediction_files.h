#pragma once

#include <string>
#include <vector>

#include "prediction.h"

namespace verlet_cable::cable_fit {

/// Where the prediction of a recording is written in a directory.
std::string prediction_path(const std::string& directory, const std::string& recording);

/// Writes predictions, one a recording, into a directory, which is made. Adds what could not be written to `failures`; an entry
/// is empty where all went well.
void write_prediction_files(const std::string& directory, const std::vector<Recording>& recordings,
                            const std::vector<Prediction>& predictions, std::vector<std::string>& failures);

}  // namespace verlet_cable::cable_fit
