use airlight::*;
use glam::Vec3;
use std::time::Instant;
struct R(u64);
impl R {
    fn f(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 40) as f64 / 16777216.0) as f32
    }
}
fn main() {
    let n = 1usize << 18;
    let mut r = R(7);
    let mut c: Vec<Vec<f32>> = (0..10).map(|k| vec![0.; n + 64 * k]).collect();
    for i in 0..n {
        let d = loop {
            let v = Vec3::new(2. * r.f() - 1., 2. * r.f() - 1., 2. * r.f() - 1.);
            let l = v.length_squared();
            if l < 1. && l > 1e-3 {
                break v / l.sqrt();
            }
        };
        for k in 0..3 {
            c[k][i] = 10. * (r.f() - 0.5);
            c[3 + k][i] = d[k];
        }
        c[7][i] = 1. + 19. * r.f();
        c[8][i] = r.f();
    }
    let rays = Rays {
        origin: [&c[0][..n], &c[1][..n], &c[2][..n]],
        direction: [&c[3][..n], &c[4][..n], &c[5][..n]],
        t_min: &c[6][..n],
        t_max: &c[7][..n],
    };
    let e = Emitters::One(Emitter::point_normal(Vec3::ZERO, Vec3::new(0.6, 0.64, -0.48)).unwrap());
    let m = Media::One(Medium::new(0.5, 0.2, 0.5).unwrap());
    let (mut t, mut p) = (vec![0.; n], vec![0.; n]);
    let mut res = vec![vec![]; 9];
    for _ in 0..15 {
        for (i, s) in Strategy::ALL.into_iter().enumerate() {
            let a = Instant::now();
            Sampler::new(s)
                .sample(&rays, &e, &m, &c[8][..n], &mut Samples { t: &mut t, pdf: &mut p, weight: None, r: None })
                .unwrap();
            res[i].push(a.elapsed().as_secs_f64() / n as f64 * 1e9);
        }
    }
    for (i, s) in Strategy::ALL.into_iter().enumerate() {
        res[i].sort_by(f64::total_cmp);
        print!("{s} {:.2} ", res[i][7]);
    }
    println!();
    let u: Vec<f32> = (0..8 * n).map(|_| r.f()).collect();
    let (mut t, mut p) = (vec![0.; 8 * n], vec![0.; 8 * n]);
    let mut res = vec![vec![]; 9];
    for _ in 0..5 {
        for (i, s) in Strategy::ALL.into_iter().enumerate() {
            let a = Instant::now();
            Sampler::new(s)
                .sample(&rays, &e, &m, &u, &mut Samples { t: &mut t, pdf: &mut p, weight: None, r: None })
                .unwrap();
            res[i].push(a.elapsed().as_secs_f64() / n as f64 * 1e9 / 8.);
        }
    }
    for (i, s) in Strategy::ALL.into_iter().enumerate() {
        res[i].sort_by(f64::total_cmp);
        print!("{s} {:.2} ", res[i][2]);
    }
    println!("(8 per ray)");
}
