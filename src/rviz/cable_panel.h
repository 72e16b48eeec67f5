#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/WrenchStamped.h>
#include <ros/ros.h>
#include <rviz/panel.h>
#include <verlet_cable/CableArray.h>

#include <map>
#include <string>
#include <vector>

#include "service_caller.h"

class QLabel;
class QLineEdit;
class QPushButton;
class QSpinBox;
class QTableWidget;

namespace verlet_cable {

/// A panel for one node: pause, step, reset, snapshots, how fast simulated time runs, and what every attachment bears
/// or which frame it waits for.
class CablePanel : public rviz::Panel {
  Q_OBJECT
 public:
  explicit CablePanel(QWidget* parent = nullptr);

  void onInitialize() override;
  void load(const rviz::Config& config) override;
  void save(rviz::Config config) const override;

 private Q_SLOTS:
  void followNode();
  void refresh();

 private:
  struct Load {
    std::string cable;
    ros::Subscriber subscriber;
    double force = 0;  ///< [N]
    bool known = false;
  };

  /// An attachment of a cable that is not there yet.
  struct Waiting {
    std::string name;
    std::string cable;
    std::string frame;
  };

  QWidget* makeControls();
  QWidget* makeSnapshots();
  std::string nameOf(const std::string& topic) const { return node_ + "/" + topic; }
  void receiveState(const CableArray& state);
  void receiveDiagnostics(const diagnostic_msgs::DiagnosticArray& diagnostics);
  void followAttachment(const std::string& name, const std::string& cable);
  void measureSpeed();
  void showLoads();
  void showRow(int row, const std::string& attachment, const std::string& cable, const QString& force);
  void tell(const ServiceAnswer& answer);
  /// Calls a service of the node, and tells what it answered.
  template <typename Service>
  void call(const std::string& service, const typename Service::Request& request);

  std::string node_;
  ros::Subscriber state_;
  ros::Subscriber diagnostics_;
  std::map<std::string, Load> loads_;  // by attachment
  std::vector<Waiting> waiting_;       // as diagnostics told last
  ros::WallTime heard_;                // of the node
  ros::Time stamp_;                    // of the last state
  ros::WallTime measured_;             // when the speed was measured last, at
  ros::Time measured_stamp_;
  double speed_ = 0;  // of simulated time, by that of the clock on the wall
  bool speed_known_ = false;
  bool paused_ = false;

  QLineEdit* node_edit_;
  QLabel* speed_label_;
  QPushButton* pause_button_;
  QPushButton* step_button_;
  QSpinBox* steps_;
  QTableWidget* table_;
  QLineEdit* snapshot_;
  QLabel* answer_;
  ServiceCaller services_;  // the last: its answers use the others
};

}  // namespace verlet_cable
