#include "net_keys.h"

#include "shape_keys.h"

namespace verlet_cable {
namespace {

constexpr const char* color_words = "red, green, blue, alpha: four numbers from 0 to 1";
constexpr const char* pair_words = "[i, j], two nodes";
constexpr const char* minimum_words = "[i, j, distance], two nodes and a distance [m]";
constexpr const char* net_link_words = "spring | limited | rigid, or a list of [i, j]";

template <class Owner>
Key<Owner> color_key(std::array<double, 4> Owner::*member) {
  return {"color", color_words, false,
          [member](const Value& value, Owner& owner) { owner.*member = read_numbers<4>(value, color_words); }};
}

const Choices<LinkType>& link_types() {
  static const Choices<LinkType> types{{"spring", LinkType::spring}, {"limited", LinkType::limited}, {"rigid", LinkType::rigid}};
  return types;
}

const Keys<ParticleDesc>& particle_keys() {
  static const Keys<ParticleDesc> keys = [] {
    Keys<ParticleDesc> particle{
        text_key("name", &ParticleDesc::name, name_words, true),
        vector_key("position", &ParticleDesc::position, "m"),
        vector_key("velocity", &ParticleDesc::velocity, "m/s"),
        color_key(&ParticleDesc::color),
    };
    append_fields(particle, particle_fields);
    return particle;
  }();
  return keys;
}

const Keys<GridDesc>& grid_keys() {
  static const Keys<GridDesc> keys = [] {
    Keys<GridDesc> grid{
        vector_key("origin", &GridDesc::origin, "m"),
        vector_key("x_axis", &GridDesc::x_axis, ""),
        vector_key("y_axis", &GridDesc::y_axis, ""),
    };
    append_fields(grid, grid_integer_fields);
    append_fields(grid, grid_fields);
    return grid;
  }();
  return keys;
}

const Keys<NetAttachmentDesc>& net_attachment_keys() {
  static const Keys<NetAttachmentDesc> keys{
      text_key("name", &NetAttachmentDesc::name, name_words, true),
      {"node", "a node of the net", true,
       [](const Value& value, NetAttachmentDesc& a) { a.node = read_integer(value, "a node of the net, an integer from 0"); }},
      text_key("frame", &NetAttachmentDesc::frame, frame_words),
      vector_key("offset", &NetAttachmentDesc::offset, "m"),
      pose_key("initial_pose", &NetAttachmentDesc::initial_pose),
  };
  return keys;
}

std::array<int, 2> read_pair(const Value& value) {
  std::array<int, 2> pair{0, 0};
  if (!value.node.IsSequence() || value.node.size() != 2) {
    value.reject(pair_words);
    return pair;
  }
  for (std::size_t i = 0; i < 2; ++i) pair[i] = read_integer(value.element(i, value.node[i]), pair_words);
  return pair;
}

MinimumDistanceDesc read_minimum(const Value& value) {
  MinimumDistanceDesc minimum;
  if (!value.node.IsSequence() || value.node.size() != 3) {
    value.reject(minimum_words);
    return minimum;
  }
  for (std::size_t i = 0; i < 2; ++i) minimum.nodes[i] = read_integer(value.element(i, value.node[i]), minimum_words);
  minimum.distance = read_number(value.element(2, value.node[2]), minimum_words);
  return minimum;
}

/// The contract has one key for the kind of all links and for the list of them.
void read_net_links(const Value& value, NetDesc& net) {
  if (value.node.IsSequence()) {
    net.links =
        read_list<std::array<int, 2>>(value, [](const Value& element, std::array<int, 2>& link) { link = read_pair(element); });
    return;
  }
  for (const auto& type : link_types()) {
    if (!value.node.IsScalar() || value.node.Scalar() != type.first) continue;
    net.link_type = type.second;
    return;
  }
  value.reject(net_link_words);
}

const Keys<NetDesc>& net_keys() {
  static const Keys<NetDesc> keys = [] {
    Keys<NetDesc> net{
        text_key("name", &NetDesc::name, name_words, true),
        {"grid", "a map", false, [](const Value& value, NetDesc& net) { read_map(value, grid_keys(), net.grid.emplace()); }},
        {"nodes", "a list of points", false,
         [](const Value& value, NetDesc& net) {
           net.nodes = read_list<Vector3>(value, [](const Value& element, Vector3& node) { node = read_vector(element, "m"); });
         }},
        {"links", net_link_words, false, read_net_links},
        choice_key("link_type", &NetDesc::link_type, link_types()),
        {"mass", positive.text("kg"), false,
         [](const Value& value, NetDesc& net) { net.mass = read_number(value, positive.text("kg")); }},
        {"masses", "a list of numbers", false,
         [](const Value& value, NetDesc& net) {
           net.masses = read_list<double>(
               value, [](const Value& element, double& mass) { mass = read_number(element, positive.text("kg")); });
         }},
        {"minimum_distances", "a list of [i, j, distance]", false,
         [](const Value& value, NetDesc& net) {
           net.minimum_distances = read_list<MinimumDistanceDesc>(
               value, [](const Value& element, MinimumDistanceDesc& minimum) { minimum = read_minimum(element); });
         }},
        vector_key("velocity", &NetDesc::velocity, "m/s"),
        color_key(&NetDesc::color),
        {"attachments", "a list", false,
         [](const Value& value, NetDesc& net) {
           net.attachments = read_list<NetAttachmentDesc>(
               value, [](const Value& element, NetAttachmentDesc& a) { read_map(element, net_attachment_keys(), a); });
         }},
    };
    append_fields(net, net_fields);
    return net;
  }();
  return keys;
}

void read_net(const Value& value, NetDesc& net) {
  const std::set<std::string> given = read_map(value, net_keys(), net);
  const auto key = [&](const char* name) { return value.child(name, {}).key; };
  if (given.count("link_type") && given.count("links") && !value.node["links"].IsSequence())
    value.errors->add(key("link_type"), "given, although links gives it, too", "one of the two");
  if (!given.count("grid") && !given.count("nodes"))
    value.errors->add_unread(key("nodes"), "missing", "a grid, or nodes and links");
  if (!given.count("mass") && !given.count("masses"))
    value.errors->add_unread(key("mass"), "missing", "mass of all nodes together, or masses, one for each node");
  if (net.link_type != LinkType::limited && !value.errors->is_unread(key("links")) && given.count("tolerance"))
    value.errors->add(key("tolerance"), "given with other links", "only with limited links");
}

const Keys<IntegratorDesc>& integrator_keys() {
  using Type = IntegratorDesc::Type;
  using FirstStep = IntegratorDesc::FirstStep;
  static const Keys<IntegratorDesc> keys{
      choice_key("type", &IntegratorDesc::type,
                 {{"verlet", Type::verlet}, {"euler", Type::euler}, {"rk4", Type::rk4}, {"pc5", Type::pc5}}, true),
      choice_key("first_step", &IntegratorDesc::first_step, {{"taylor", FirstStep::taylor}, {"lecture", FirstStep::lecture}}),
  };
  return keys;
}

void read_integrator(const Value& value, SceneDesc& scene) {
  if (value.node.IsMap()) {
    read_map(value, integrator_keys(), scene.integrator);
  } else {
    integrator_keys().front().read(value, scene.integrator);
  }
}

}  // namespace

void append_net_keys(Keys<SceneDesc>& keys) {
  keys.push_back({"particles", "a list of particles", false, [](const Value& value, SceneDesc& scene) {
                    scene.particles = read_list<ParticleDesc>(
                        value, [](const Value& element, ParticleDesc& p) { read_map(element, particle_keys(), p); });
                  }});
  keys.push_back({"nets", "a list of nets", false,
                  [](const Value& value, SceneDesc& scene) { scene.nets = read_list<NetDesc>(value, read_net); }});
  keys.push_back({"integrator", "verlet | euler | rk4 | pc5", false, read_integrator});
}

}  // namespace verlet_cable
