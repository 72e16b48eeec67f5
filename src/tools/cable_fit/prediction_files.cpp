#include "prediction_files.h"

#include <filesystem>

#include "common/messages.h"
#include "common/output_file.h"
#include "report.h"

namespace verlet_cable::cable_fit {

std::string prediction_path(const std::string& directory, const std::string& recording) {
  return (std::filesystem::path(directory) / std::filesystem::path(recording).filename()).string();
}

void write_prediction_files(const std::string& directory, const std::vector<Recording>& recordings,
                            const std::vector<Prediction>& predictions, std::vector<std::string>& failures) {
  std::error_code problem;
  std::filesystem::create_directories(directory, problem);
  if (problem) return failures.push_back("cannot make the directory " + tools::quoted_path(directory) + ": " + problem.message());
  for (std::size_t i = 0; i < predictions.size(); ++i)
    failures.push_back(
        tools::write_file(prediction_path(directory, recordings[i].path), prediction_csv(recordings[i], predictions[i])));
}

}  // namespace verlet_cable::cable_fit
