//! A shared library of peers that draws distances uniformly along the ray, built by the compiler of these tests.

use std::fs;
use std::path::Path;
use std::process::Command;

const SOURCE: &str = r#"
#[repr(C)]
pub struct Batch { inputs: [*const f32; 8], t: *mut f32, pdf: *mut f32, parameters: *const f32 }

unsafe fn uniform(batch: *const Batch, from: usize, to: usize) {
    let batch = &*batch;
    for i in from..to {
        let (t_max, u) = (*batch.inputs[6].add(i), *batch.inputs[7].add(i));
        *batch.t.add(i) = u * t_max;
        *batch.pdf.add(i) = 1.0 / t_max;
    }
}

macro_rules! kernels { ($($name:ident),*) => { $(
    #[no_mangle]
    pub unsafe extern "C" fn $name(batch: *const Batch, from: usize, to: usize) { uniform(batch, from, to) }
)* } }

kernels!(peer_equiangular, peer_point_normal, peer_taylor_transmittance_4, peer_taylor_transmittance_8);
"#;

/// Its path, in a folder.
pub(crate) fn build(folder: &Path) -> String {
    let (source, library) = (folder.join("peers.rs"), folder.join("libpeers.so"));
    fs::write(&source, SOURCE).unwrap();
    let output = Command::new("rustc")
        .args(["--crate-type", "cdylib", "--edition", "2021", "-O", "-o"])
        .args([&library, &source])
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    library.into_os_string().into_string().unwrap()
}
