#include "options.h"

#include "common/command_line.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable::cable_sim {
namespace {

constexpr Range duration_range{0, 1e9, "0 or more"};
constexpr Range rate_range{1e-9, 1e9, "any number above 0, at most 1 / time_step"};
constexpr const char* file = "the name of a file";

constexpr const char* usage =
    "usage: cable_sim SCENE.yaml [options]\n"
    "Runs a scene offline.";
constexpr const char* footer =
    "Files appear under their names when they are complete; devices are written directly. A signal ends the run\n"
    "between two steps and keeps what was simulated until then; a second signal ends it at once.\n"
    "exit status: 0 done, 2 a bad scene, motion, loads or option, 3 it had to stop: a fault, a full disk, a signal";

/// Other names would say that something else is in the file.
void require_ending(const char* option, const std::string& path, const std::vector<std::string>& endings,
                    std::vector<std::string>& errors) {
  if (path.empty()) return;
  std::string allowed;
  for (const std::string& ending : endings) {
    if (has_ending(path, ending)) return;
    allowed += (allowed.empty() ? "" : " or ") + ending;
  }
  errors.push_back(std::string(option) + ": " + in_quotes(path) + "; allowed: a name that ends in " + allowed);
}

}  // namespace

bool has_ending(const std::string& path, const std::string& ending) {
  return path.size() > ending.size() && path.compare(path.size() - ending.size(), ending.size(), ending) == 0;
}

Options parse_options(const std::vector<std::string>& arguments, std::vector<std::string>& errors) {
  Options options;
  tools::CommandLine line(usage, footer);
  line.add_number("--duration", "S", "time to simulate [s], default 10", options.duration, duration_range, "s");
  line.add_text("--motion", "CSV", "poses of frames over time: t,frame,x,y,z,qx,qy,qz,qw", options.motion, file);
  line.add_text("--loads", "CSV", "forces and torques over time: t,name,on,node,fx,fy,fz,tx,ty,tz", options.loads, file);
  line.add_text("--output", "CSV", "the nodes over time: t,cable,node,x,y,z,vx,vy,vz,tension", options.output, file);
  line.add_text("--bodies", "CSV", "the bodies over time: t,body,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz", options.bodies, file);
  double rate = 0;
  line.add_number("--rate", "HZ",
                  "rows per second of --output and --bodies, and times of --usd and --vtk, at most 1 / time_step; default 100, "
                  "or 1 / time_step "
                  "if that is less",
                  rate, rate_range, "Hz");
  line.add_text("--summary", "JSON", "times, energies, forces and events", options.summary, file);
  line.add_text("--plot", "PNG", "a picture of the shapes over time and the forces at attachments; needs matplotlib",
                options.plot, file);
  line.add_text("--gif", "GIF", "the motion; needs matplotlib", options.gif, file);
  line.add_text("--movie", "FILE", "the motion, as FILE.gif or FILE.mp4; needs matplotlib, and ffmpeg for the latter",
                options.movie, file);
  line.add_text("--usd", "USDA", "the motion as a scene of USD, for Blender, usdview and Omniverse", options.usd, file);
  line.add_text("--vtk", "DIR", "the motion for ParaView: cables.pvd, bodies.pvd, obstacles.pvd and a file for each time",
                options.vtk, "the name of a directory");
  line.add_flag("--settle", "put the cables into static equilibrium before t = 0", options.settle);
  const std::vector<std::string> scenes = line.parse(arguments, errors);
  options.help = line.help();
  require_ending("--plot", options.plot, {".png"}, errors);
  require_ending("--gif", options.gif, {".gif"}, errors);
  require_ending("--movie", options.movie, {".gif", ".mp4"}, errors);
  require_ending("--usd", options.usd, {".usda"}, errors);
  options.has_rate = rate > 0;
  if (options.has_rate) options.rate = rate;
  for (const std::string& scene : scenes) {
    if (!options.scene.empty())
      errors.push_back(in_quotes(scene) + ": a second scene; allowed: one, and " + in_quotes(options.scene) +
                       " is given already");
    if (scene.empty()) errors.push_back("\"\": an empty argument; allowed: the name of a scene file");
    if (options.scene.empty()) options.scene = scene;
  }
  if (options.scene.empty() && options.help.empty() && !line.left_out())
    errors.push_back("no scene; type: cable_sim SCENE.yaml [options]; cable_sim --help lists the options");
  return options;
}

}  // namespace verlet_cable::cable_sim
