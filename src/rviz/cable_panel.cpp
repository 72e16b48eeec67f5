#include "cable_panel.h"

#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>
#include <verlet_cable/RestoreState.h>
#include <verlet_cable/SaveState.h>
#include <verlet_cable/Step.h>

#include <QFormLayout>
#include <QGroupBox>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSpinBox>
#include <QTableWidget>
#include <QTimer>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>
#include <pluginlib/class_list_macros.hpp>
#include <set>

namespace verlet_cable {
namespace {

constexpr int refresh_period = 200;                   // [ms]
constexpr int row_height = 24, smallest_table = 130;  // [pixels]
constexpr std::size_t most_attachments = 100;
const ros::WallDuration speed_period(1);
const ros::WallDuration longest_silence(2);
constexpr double standing = 0.001;  // of real time
/// In diagnostics: what follows is CABLE/ATTACHMENT, and the value a frame.
const std::string waiting_key = "waiting_attachment ";

double length(const geometry_msgs::Vector3& v) {
  return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

QTableWidgetItem* cell(const QString& text, Qt::Alignment alignment) {
  auto* const item = new QTableWidgetItem(text);
  item->setTextAlignment(alignment | Qt::AlignVCenter);
  return item;
}

}  // namespace

CablePanel::CablePanel(QWidget* parent)
    : rviz::Panel(parent),
      node_edit_(new QLineEdit("/cable")),
      speed_label_(new QLabel),
      pause_button_(new QPushButton("Pause")),
      step_button_(new QPushButton("Step")),
      steps_(new QSpinBox),
      table_(new QTableWidget(0, 3)),
      snapshot_(new QLineEdit("first")),
      answer_(new QLabel) {
  auto* const form = new QFormLayout;
  form->addRow("Node", node_edit_);
  form->addRow("Speed", speed_label_);
  table_->setHorizontalHeaderLabels({"Attachment", "Cable", "Force [N]"});
  table_->horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
  table_->horizontalHeader()->setSectionResizeMode(2, QHeaderView::ResizeToContents);
  table_->verticalHeader()->hide();
  table_->verticalHeader()->setDefaultSectionSize(row_height);
  table_->setMinimumHeight(smallest_table);
  table_->setEditTriggers(QAbstractItemView::NoEditTriggers);
  answer_->setWordWrap(true);
  answer_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  auto* const layout = new QVBoxLayout;
  layout->addLayout(form);
  layout->addWidget(makeControls());
  layout->addWidget(table_);
  layout->addWidget(makeSnapshots());
  layout->addWidget(answer_);
  setLayout(layout);
  connect(node_edit_, &QLineEdit::editingFinished, this, &CablePanel::followNode);
}

QWidget* CablePanel::makeControls() {
  auto* const box = new QWidget;
  auto* const layout = new QHBoxLayout(box);
  layout->setContentsMargins(0, 0, 0, 0);
  auto* const reset = new QPushButton("Reset");
  steps_->setRange(1, 1000000);
  steps_->setValue(10);
  steps_->setToolTip("Number of time steps, while paused");
  for (QWidget* widget : {static_cast<QWidget*>(pause_button_), static_cast<QWidget*>(step_button_),
                          static_cast<QWidget*>(steps_), static_cast<QWidget*>(reset)})
    layout->addWidget(widget);
  connect(pause_button_, &QPushButton::clicked, this, [this] {
    std_srvs::SetBool::Request request;
    request.data = !paused_;
    call<std_srvs::SetBool>("pause", request);
  });
  connect(step_button_, &QPushButton::clicked, this, [this] {
    Step::Request request;
    request.steps = static_cast<std::uint32_t>(steps_->value());
    call<Step>("step", request);
  });
  connect(reset, &QPushButton::clicked, this, [this] { call<std_srvs::Trigger>("reset", {}); });
  return box;
}

QWidget* CablePanel::makeSnapshots() {
  auto* const box = new QGroupBox("Snapshot");
  auto* const layout = new QHBoxLayout(box);
  auto* const save = new QPushButton("Save");
  auto* const restore = new QPushButton("Restore");
  for (QWidget* widget : {static_cast<QWidget*>(snapshot_), static_cast<QWidget*>(save), static_cast<QWidget*>(restore)})
    layout->addWidget(widget);
  connect(save, &QPushButton::clicked, this, [this] {
    SaveState::Request request;
    request.name = snapshot_->text().toStdString();
    call<SaveState>("save_state", request);
  });
  connect(restore, &QPushButton::clicked, this, [this] {
    RestoreState::Request request;
    request.name = snapshot_->text().toStdString();
    call<RestoreState>("restore_state", request);
  });
  return box;
}

void CablePanel::onInitialize() {
  followNode();
  auto* const timer = new QTimer(this);
  connect(timer, &QTimer::timeout, this, &CablePanel::refresh);
  timer->start(refresh_period);
}

void CablePanel::load(const rviz::Config& config) {
  rviz::Panel::load(config);
  QString node;
  if (config.mapGetString("Node", &node)) node_edit_->setText(node);
  followNode();
}

void CablePanel::save(rviz::Config config) const {
  rviz::Panel::save(config);
  config.mapSetValue("Node", node_edit_->text());
}

void CablePanel::followNode() {
  const std::string node = node_edit_->text().trimmed().toStdString();
  if (node == node_) return;
  state_.shutdown();
  diagnostics_.shutdown();
  loads_.clear();
  waiting_.clear();
  heard_ = {};
  node_ = node;
  std::string problem;
  if (node.empty() || !ros::names::validate(node, problem)) {
    tell({false, node.empty() ? "Node is empty; type the name of the cable node, such as /cable" : problem});
    return;
  }
  state_ = ros::NodeHandle().subscribe<CableArray>(nameOf("state"), 1,
                                                   [this](const CableArray::ConstPtr& state) { receiveState(*state); });
  diagnostics_ = ros::NodeHandle().subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", 10,
      [this](const diagnostic_msgs::DiagnosticArray::ConstPtr& diagnostics) { receiveDiagnostics(*diagnostics); });
  Q_EMIT configChanged();
}

void CablePanel::receiveState(const CableArray& state) {
  heard_ = ros::WallTime::now();
  stamp_ = state.header.stamp;
  std::set<std::string> there;
  for (const Cable& cable : state.cables) {
    for (const std::string& attachment : cable.attachments) {
      if (there.size() == most_attachments) break;
      there.insert(attachment);
      followAttachment(attachment, cable.name);
    }
  }
  for (auto entry = loads_.begin(); entry != loads_.end();)
    entry = there.count(entry->first) > 0 ? std::next(entry) : loads_.erase(entry);
}

void CablePanel::receiveDiagnostics(const diagnostic_msgs::DiagnosticArray& diagnostics) {
  const std::string wanted = ros::names::resolve(node_).substr(1) + ": simulation";
  for (const diagnostic_msgs::DiagnosticStatus& status : diagnostics.status) {
    if (status.name != wanted) continue;
    waiting_.clear();
    for (const diagnostic_msgs::KeyValue& value : status.values) {
      if (value.key.rfind(waiting_key, 0) != 0) continue;
      const std::size_t slash = value.key.find('/');
      if (slash == std::string::npos) continue;
      waiting_.push_back(
          {value.key.substr(slash + 1), value.key.substr(waiting_key.size(), slash - waiting_key.size()), value.value});
    }
  }
}

void CablePanel::followAttachment(const std::string& name, const std::string& cable) {
  const auto [entry, is_new] = loads_.try_emplace(name);
  entry->second.cable = cable;
  if (!is_new) return;
  entry->second.subscriber = ros::NodeHandle().subscribe<geometry_msgs::WrenchStamped>(
      nameOf("wrench/" + name), 1, [this, name](const geometry_msgs::WrenchStamped::ConstPtr& message) {
        Load& load = loads_[name];
        load.force = length(message->wrench.force);
        load.known = true;
      });
}

/// Over a second at least, so that it does not flicker.
void CablePanel::measureSpeed() {
  const ros::WallTime now = ros::WallTime::now();
  if (now - measured_ < speed_period) return;
  speed_known_ = !measured_.isZero();
  speed_ = (stamp_ - measured_stamp_).toSec() / (now - measured_).toSec();
  paused_ = speed_known_ && std::abs(speed_) < standing;
  measured_ = now;
  measured_stamp_ = stamp_;
}

void CablePanel::refresh() {
  const bool there = ros::WallTime::now() - heard_ < longest_silence;
  if (there) {
    measureSpeed();
  } else {
    loads_.clear();
    waiting_.clear();
    measured_ = {};
    paused_ = speed_known_ = false;
  }
  speed_label_->setText(!there          ? "no messages from this node"
                        : !speed_known_ ? "..."
                        : paused_       ? "paused"
                                        : QString::number(speed_, 'f', 2) + " × real time");
  pause_button_->setText(paused_ ? "Resume" : "Pause");
  step_button_->setEnabled(there && paused_);
  showLoads();
}

/// Diagnostics are older than the state: what waits by them may be there already.
void CablePanel::showLoads() {
  const auto there = [this](const Waiting& waiting) { return loads_.count(waiting.name) > 0; };
  waiting_.erase(std::remove_if(waiting_.begin(), waiting_.end(), there), waiting_.end());
  table_->setRowCount(static_cast<int>(loads_.size() + waiting_.size()));
  int row = 0;
  for (const auto& [name, load] : loads_)
    showRow(row++, name, load.cable, load.known ? QString::number(load.force, 'f', 2) : "-");
  for (const Waiting& waiting : waiting_)
    showRow(row++, waiting.name, waiting.cable, "waits for " + QString::fromStdString(waiting.frame));
}

void CablePanel::showRow(int row, const std::string& attachment, const std::string& cable, const QString& force) {
  table_->setItem(row, 0, cell(QString::fromStdString(attachment), Qt::AlignLeft));
  table_->setItem(row, 1, cell(QString::fromStdString(cable), Qt::AlignLeft));
  table_->setItem(row, 2, cell(force, Qt::AlignRight));
}

void CablePanel::tell(const ServiceAnswer& answer) {
  answer_->setStyleSheet(answer.success ? "" : "color: #c03030");
  answer_->setText(QString::fromStdString(answer.message));
}

template <typename Service>
void CablePanel::call(const std::string& service, const typename Service::Request& request) {
  services_.call<Service>(nameOf(service), request, [this](const ServiceAnswer& answer) { tell(answer); });
}

}  // namespace verlet_cable

PLUGINLIB_EXPORT_CLASS(verlet_cable::CablePanel, rviz::Panel)
