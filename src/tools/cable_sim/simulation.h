#pragma once

#include "common/program.h"
#include "common/progress_bar.h"
#include "csv_writer.h"
#include "event_log.h"
#include "job.h"
#include "picture_record.h"
#include "scene/frame_source.h"
#include "summary.h"
#include "usd_record.h"
#include "vtk_writer.h"

namespace verlet_cable::cable_sim {

/// What a run fills.
struct Recorders {
  CsvWriter* nodes;         ///< may be null
  CsvWriter* bodies;        ///< likewise
  PictureRecord* pictures;  ///< likewise
  UsdRecord* usd;           ///< likewise
  VtkWriter* vtk;           ///< likewise
  Summary& summary;
  EventLog& events;
  tools::ProgressBar& progress;
  const tools::StopRequest& stop;
};

/// How many steps the average of the last 0.1 s is over.
std::int64_t averaged_steps(const Job& job);

enum class RunEnd {
  done,
  fault,          ///< the last event
  signal,         ///< that asked to stop
  output_failed,  ///< rows cannot be written
};

/// Steps the world to the end of the job, or until it has to stop. `loads`: those that are still to come.
RunEnd simulate(const Job& job, const FrameSource& frames, LoadPlayer loads, World& world, const Recorders& recorders);

}  // namespace verlet_cable::cable_sim
