#include "core/interrupt.hpp"

#include <chrono>
#include <utility>

#include "polhode/core/interrupt.hpp"

namespace polhode {
namespace {

using InterruptClock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds between_checks{20};

struct ThreadInterrupts {
  const std::function<void()>* check = nullptr;
  const std::atomic<bool>* stopped = nullptr;
  InterruptClock::time_point next;
};

thread_local ThreadInterrupts interrupts;

}  // namespace

InterruptGuard::InterruptGuard(std::function<void()> check) : check_(std::move(check)), outer_(interrupts.check) {
  interrupts.check = &check_;
  if (outer_ == nullptr) interrupts.next = {};
}

InterruptGuard::~InterruptGuard() { interrupts.check = outer_; }

HelperThread::HelperThread(const std::atomic<bool>& stopped) { interrupts.stopped = &stopped; }
HelperThread::~HelperThread() { interrupts.stopped = nullptr; }

bool is_interruptible() { return interrupts.check != nullptr || interrupts.stopped != nullptr; }

void check_interrupt() {
  if (interrupts.stopped != nullptr && *interrupts.stopped) throw Interrupted{};
  if (interrupts.check == nullptr) return;
  const InterruptClock::time_point now = InterruptClock::now();
  if (now < interrupts.next) return;
  const bool first = interrupts.next == InterruptClock::time_point{};   // short work is not asked at all
  interrupts.next = now + between_checks;
  if (!first) (*interrupts.check)();
}

}  // namespace polhode
