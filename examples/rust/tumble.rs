// A thrown block from Rust, by the C interface. Declare what the program uses, as polhode/polhode.h has it.
//
//   rustc -O tumble.rs -L /opt/polhode/lib -C link-arg=-Wl,-rpath,/opt/polhode/lib
use std::ffi::CStr;
use std::os::raw::{c_char, c_int};
use std::ptr::{null, null_mut};

#[repr(C)]
struct FreeMotionHandle {
    _private: [u8; 0],
}

#[link(name = "polhode_c")]
extern "C" {
    fn polhode_abi_version() -> c_int;
    fn polhode_last_error() -> *const c_char;
    fn polhode_free_motion_create(
        inertia: *const f64,
        omega: *const f64,
        attitude: *const f64,
        made: *mut *mut FreeMotionHandle,
    ) -> c_int;
    fn polhode_free_motion_destroy(motion: *mut FreeMotionHandle);
    fn polhode_free_motion_at(
        motion: *const FreeMotionHandle,
        times: *const f64,
        count: usize,
        omega: *mut f64,
        attitude: *mut f64,
    ) -> c_int;
    fn polhode_free_motion_flip_times(
        motion: *const FreeMotionHandle,
        begin: f64,
        end: f64,
        times: *mut f64,
        room: usize,
        count: *mut usize,
    ) -> c_int;
}

fn check(status: c_int) -> Result<(), String> {
    match status {
        0 => Ok(()),
        _ => Err(unsafe { CStr::from_ptr(polhode_last_error()) }.to_string_lossy().into_owned()),
    }
}

struct FreeMotion(*mut FreeMotionHandle);

impl FreeMotion {
    fn new(moments: [f64; 3], omega: [f64; 3]) -> Result<Self, String> {
        let mut inertia = [0.0; 9];
        for i in 0..3 {
            inertia[4 * i] = moments[i];
        }
        let mut made = null_mut();
        check(unsafe { polhode_free_motion_create(inertia.as_ptr(), omega.as_ptr(), null(), &mut made) })?;
        Ok(FreeMotion(made))
    }

    fn attitude(&self, t: f64) -> Result<[f64; 4], String> {
        let mut q = [0.0; 4];
        check(unsafe { polhode_free_motion_at(self.0, &t, 1, null_mut(), q.as_mut_ptr()) })?;
        Ok(q)
    }

    fn flip_times(&self, begin: f64, end: f64) -> Result<Vec<f64>, String> {
        let mut times = vec![0.0; 16];
        let mut count = 0;
        let (first, room) = (times.as_mut_ptr(), times.len());
        check(unsafe { polhode_free_motion_flip_times(self.0, begin, end, first, room, &mut count) })?;
        times.truncate(count);
        Ok(times)
    }
}

impl Drop for FreeMotion {
    fn drop(&mut self) {
        unsafe { polhode_free_motion_destroy(self.0) }
    }
}

fn main() -> Result<(), String> {
    assert_eq!(unsafe { polhode_abi_version() }, 1);
    let block = FreeMotion::new([0.2, 0.4, 0.52], [0.01, 5.0, 0.01])?;
    for t in block.flip_times(0.0, 15.0)? {
        println!("flip at {t:.6} s");
    }
    println!("bits after 1e6 s: {:016x}", block.attitude(1e6)?[0].to_bits());
    println!("refused: {}", FreeMotion::new([0.2, 0.4, 0.7], [0.0; 3]).err().unwrap_or_default());
    Ok(())
}
