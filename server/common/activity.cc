#include "server/common/activity.h"

#include <unistd.h>

namespace duet::server::common {
namespace {

struct alignas(64) Slot {
  std::atomic<pid_t> thread_id{0};  // 0: free
  std::atomic<const StepKind*> step{nullptr};
  std::atomic<std::uint64_t> beat{0};
};

// Trivially destructible, because threads may still use them while the process exits.
std::array<Slot, kMaxThreads> slots;
std::atomic<std::size_t> used_slots{0};  // slots from this index on were never used
Vitals vitals;

void RaiseUsedSlots(std::size_t count) {
  std::size_t seen = used_slots;
  while (seen < count && !used_slots.compare_exchange_weak(seen, count)) {
  }
}

Slot* TakeSlot() {
  for (std::size_t i = 0; i < slots.size(); ++i) {
    pid_t free = 0;
    if (slots[i].thread_id.compare_exchange_strong(free, gettid())) {
      RaiseUsedSlots(i + 1);
      return &slots[i];
    }
  }
  return nullptr;
}

// Gives the slot to other threads when its thread ends.
struct SlotHolder {
  Slot* slot = TakeSlot();
  ~SlotHolder() {
    if (slot == nullptr) return;
    slot->step = nullptr;
    ++slot->beat;
    slot->thread_id = 0;
  }
};

Slot* OwnSlot() {
  thread_local const SlotHolder holder;
  return holder.slot;
}

// Returns the previous step.
const StepKind* Begin(const StepKind* kind) {
  Slot* const slot = OwnSlot();
  if (slot == nullptr) return nullptr;
  const StepKind* const before = slot->step.load(std::memory_order_relaxed);
  slot->step.store(kind, std::memory_order_relaxed);
  // The beat is stored last: a reader that sees an old beat with a new step sees a new beat next
  // time.
  slot->beat.fetch_add(1, std::memory_order_release);
  return before;
}

}  // namespace

Step::Step(const StepKind* kind) : outer_(Begin(kind)) {}

Step::~Step() { Begin(outer_); }

void ReadThreads(ThreadStates* states) {
  const std::size_t used = used_slots;
  for (std::size_t i = 0; i < used; ++i) {
    const Slot& slot = slots[i];
    const std::uint64_t beat = slot.beat.load(std::memory_order_acquire);
    (*states)[i] = {slot.thread_id.load(std::memory_order_relaxed),
                    slot.step.load(std::memory_order_relaxed), beat};
  }
}

Vitals& ProcessVitals() { return vitals; }

}  // namespace duet::server::common
