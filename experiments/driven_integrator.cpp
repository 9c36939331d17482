#include "experiments/driven_integrator.hpp"

#include <utility>

namespace driftless {
namespace {

class DrivenIntegrator : public Integrator {
 public:
  DrivenIntegrator(std::unique_ptr<Integrator> integrator, SlabHeater heater)
      : integrator_(std::move(integrator)), heater_(std::move(heater)) {}

  void step(System& system, double dt) override {
    integrator_->step(system, dt);
    heater_.act(system, dt);
  }

  /// What the slabs keep, after its length.
  std::vector<double> save() const override {
    auto saved = heater_.save();
    saved.insert(saved.begin(), static_cast<double>(saved.size()));
    const auto own = integrator_->save();
    saved.insert(saved.end(), own.begin(), own.end());
    return saved;
  }
  void load(const std::vector<double>& saved) override {
    if (saved.empty()) return;  // saved before the first step
    const auto own = saved.begin() + 1 + static_cast<std::ptrdiff_t>(saved[0]);
    heater_.load({saved.begin() + 1, own});
    integrator_->load({own, saved.end()});
  }
  bool may_reorder_storage() const override { return integrator_->may_reorder_storage(); }
  void follow_storage(const Places& places) override { integrator_->follow_storage(places); }

 private:
  std::unique_ptr<Integrator> integrator_;
  SlabHeater heater_;
};

}  // namespace

std::unique_ptr<Integrator> driven(std::unique_ptr<Integrator> integrator, const Scene& scene,
                                   const Noise& noise) {
  if (!scene.heat_slabs) return integrator;
  SlabHeater heater(*scene.heat_slabs, Fluid(scene.fluid), scene_box(scene), noise);
  return std::make_unique<DrivenIntegrator>(std::move(integrator), std::move(heater));
}

}  // namespace driftless
