#pragma once

#include "net/link_rows.h"

namespace verlet_cable {

/// The same law for links whose pull turns with them: it acts along their directions at the end of the step. Along those at the
/// start, the motion of a taut link across itself grows where h^2 pull > length mass, and a large net is full of such links where
/// it is held. Where that motion is resolved, both do the same, but for a little angular momentum that this one loses.

/// One sweep: each link's law is fulfilled in turn, length and direction, with what its nodes do at present.
void sweep_turning_links(const LinkRun& run, const LinkLaw& law, double h, LinkArrays& arrays);

// Of these, `row` is a run of stride 1 whose links may share nodes.

/// Sets the inverse lengths, and applies the impulses that the links have from the step before.
void start_turning_links(const LinkRun& row, LinkArrays& arrays);
/// What each link lacks of the impulse of its law at present [N s], by link.
void find_lacking(const LinkRun& row, const LinkLaw& law, double h, const LinkArrays& arrays, std::vector<double>& lacking);
/// Adds to the links' impulses, by link [N s]. `scratch`: as many as the row has links, or more.
void add_impulses(const LinkRun& row, const std::vector<double>& added, LinkArrays& arrays, VectorArray& scratch);

}  // namespace verlet_cable
