use super::*;

fn unit_sphere_at(x: f64, y: f64, z: f64) -> Sphere {
    Sphere::new(DVec3::new(x, y, z), 1.0).unwrap()
}

fn forward_from(origin: DVec3) -> Ray {
    Ray {
        origin,
        direction: DVec3::Z,
    }
}

#[test]
fn refuses_what_is_no_sphere() {
    assert_eq!(Sphere::new(DVec3::ZERO, 0.0), Err(SphereError::Radius(0.0)));
    assert_eq!(
        Sphere::new(DVec3::ZERO, -1.0),
        Err(SphereError::Radius(-1.0))
    );
    assert!(Sphere::new(DVec3::ZERO, f64::NAN).is_err());
    assert!(Sphere::new(DVec3::new(0.0, f64::INFINITY, 0.0), 1.0).is_err());
}

#[test]
fn the_nearer_crossing_is_hit() {
    let hit = unit_sphere_at(0.0, 0.0, 5.0)
        .hit(&forward_from(DVec3::ZERO))
        .unwrap();
    assert_eq!(
        hit,
        Hit {
            t: 4.0,
            normal: -DVec3::Z,
            inner_side: false
        }
    );
}

#[test]
fn t_counts_multiples_of_the_direction() {
    let ray = Ray {
        origin: DVec3::ZERO,
        direction: DVec3::Z * 8.0,
    };
    assert_eq!(unit_sphere_at(0.0, 0.0, 5.0).hit(&ray).unwrap().t, 0.5);
}

#[test]
fn tangent_ray_hits() {
    let hit = unit_sphere_at(0.0, 1.0, 5.0)
        .hit(&forward_from(DVec3::ZERO))
        .unwrap();
    assert_eq!(
        hit,
        Hit {
            t: 5.0,
            normal: -DVec3::Y,
            inner_side: false
        }
    );
}

#[test]
fn sphere_behind_is_missed() {
    assert!(
        unit_sphere_at(0.0, 0.0, -5.0)
            .hit(&forward_from(DVec3::ZERO))
            .is_none()
    );
}

#[test]
fn from_inside_the_far_side_is_hit() {
    let hit = unit_sphere_at(0.0, 0.0, 0.5)
        .hit(&forward_from(DVec3::ZERO))
        .unwrap();
    assert_eq!(
        hit,
        Hit {
            t: 1.5,
            normal: DVec3::Z,
            inner_side: true
        }
    );
}

#[test]
fn origin_on_the_surface_hits_only_across() {
    let across = unit_sphere_at(0.0, 0.0, 1.0)
        .hit(&forward_from(DVec3::ZERO))
        .unwrap();
    assert_eq!(
        across,
        Hit {
            t: 2.0,
            normal: DVec3::Z,
            inner_side: true
        }
    );
    assert!(
        unit_sphere_at(0.0, 0.0, -1.0)
            .hit(&forward_from(DVec3::ZERO))
            .is_none()
    );
}
