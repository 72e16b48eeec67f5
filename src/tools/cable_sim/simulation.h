#pragma once

#include "csv_writer.h"
#include "event_log.h"
#include "frame_source.h"
#include "job.h"
#include "progress_bar.h"
#include "summary.h"

namespace verlet_cable::cable_sim {

/// What a run fills.
struct Recorders {
  CsvWriter* csv;  ///< may be null
  Summary& summary;
  EventLog& events;
  ProgressBar& progress;
};

/// The first step whose forces belong to the average of the last 0.1 s.
std::int64_t first_averaged_step(const Job& job);

/// Steps the world to the end of the job. False if it had to stop at a fault, which is the last event then.
bool simulate(const Job& job, double rate, const FrameSource& frames, World& world, const Recorders& recorders);

}  // namespace verlet_cable::cable_sim
