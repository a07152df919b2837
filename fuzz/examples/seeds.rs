//! Makes the seeds of the fuzz targets anew: `seeds/FAMILY-NUMBER`, two rays of a family of `airlight accuracy` as an input of
//! the targets on batches; `files/`, columns of each dtype and archives of them, for the reader of wavefronts.
//!
//! ```sh
//! cargo run --example seeds
//! ```

use airlight::{FARTHEST, Rays};
use airlight_fuzz::families::{Case, Columns, Family};
use airlight_fuzz::{HEAD, Patch, files};
use std::error::Error;
use std::path::Path;
use zip::CompressionMethod;

/// Of each family.
const SEEDS: u64 = 6;
const RAYS: usize = 2;

fn main() -> Result<(), Box<dyn Error>> {
    let home = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = home.join("seeds");
    std::fs::create_dir_all(&folder)?;
    for family in Family::ALL {
        for number in 0..SEEDS {
            let cases = [0, 1].map(|ray| family.case(number, ray));
            std::fs::write(folder.join(format!("{}-{number}", family.name())), seed(&cases, number as u8))?;
        }
    }
    let folder = home.join("files");
    std::fs::create_dir_all(&folder)?;
    // 0.25 and 1.
    let single = files::npy("<f4", [0.25f32, 1.0].map(f32::to_le_bytes).as_flattened());
    std::fs::write(folder.join("f4.npy"), &single)?;
    std::fs::write(folder.join("f8.npy"), files::npy(">f8", [0.25f64, 1.0].map(f64::to_be_bytes).as_flattened()))?;
    std::fs::write(folder.join("f2.npy"), files::npy("f2", [0x3400u16, 0x3c00].map(u16::to_le_bytes).as_flattened()))?;
    std::fs::write(folder.join("stored.npz"), files::npz(&single, CompressionMethod::Stored)?)?;
    std::fs::write(folder.join("deflated.npz"), files::npz(&single, CompressionMethod::Deflated)?)?;
    Ok(())
}

/// The head, and every value of the rays.
fn seed(cases: &[Case; RAYS], number: u8) -> Vec<u8> {
    let columns = Columns::new(cases);
    let Rays { origin, direction, t_min, t_max, .. } = columns.rays();
    let (mu, cones) = (columns.medium(), columns.cones());
    let [mu_a, mu_s, g] = mu;
    // A column for each value, in the order of a patch.
    let none = [-1.0f32; RAYS];
    let [outer, inner] = cones.unwrap_or([&none[..]; 2]);
    let middle: Vec<f32> = t_min.iter().zip(t_max).map(|(from, to)| 0.5 * (from + to.min(FARTHEST))).collect();
    let of_rays = origin.into_iter().chain(direction).chain([t_min, t_max]);
    let of_lights = columns.position().into_iter().chain(columns.normal()).chain([outer, inner]);
    let of_fog = [mu_a; 4].into_iter().chain([mu_s; 4]).chain([g]);
    let values = of_rays.chain(of_lights).chain(of_fog).chain([&columns.u[..], &middle]);

    let mut seed = vec![0; HEAD];
    // Rays, a variate each, emitters and media of columns, and whatever strategy, precision, nodes and backends.
    (seed[0], seed[2]) = (RAYS as u8, if cones.is_some() { 2 } else { 3 } + 4 * 2);
    seed[3..7].fill(number);
    for (column, values) in values.enumerate() {
        for (ray, value) in values.iter().enumerate() {
            let [a, b, c, d] = value.to_le_bytes();
            let patch: Patch = [column as u8, ray as u8, a, b, c, d];
            seed.extend(patch);
        }
    }
    seed
}
