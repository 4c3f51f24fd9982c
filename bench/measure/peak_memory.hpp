// The memory that something takes at its worst moment.
#pragma once

namespace dermis::bench {

/// The most memory that this process has held since it was made, beyond what it held then. Linux keeps the mark (VmHWM)
/// and lets it be taken back; elsewhere, or where that is not allowed, the value is 0.
class PeakMemory {
 public:
  PeakMemory();
  double mb() const;

 private:
  double start_mb_;
};

/// The most memory that this process has held, MB of 2^20 bytes; 0 where that is not known. The accounts of a finished
/// child (ru_maxrss) will not do: they begin with what its parent held.
double process_peak_mb();

}  // namespace dermis::bench
