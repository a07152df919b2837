//! Where names go so that they cover neither each other nor a mark.

/// Across and down: of a place, or of a size.
type Corner = (i32, i32);

/// A rectangle: left, top, right, bottom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Area(pub(super) [i32; 4]);

impl Area {
    /// What both cover.
    fn common(self, other: Self) -> i32 {
        let (Self([l, t, r, b]), Self([left, top, right, bottom])) = (self, other);
        (r.min(right) - l.max(left)).max(0) * (b.min(bottom) - t.max(top)).max(0)
    }

    fn size(self) -> i32 {
        let Self([l, t, r, b]) = self;
        (r - l) * (b - t)
    }
}

/// Puts a text of each size beside its point, inside a frame and off what is `taken` already; returns their areas.
///
/// Each in turn takes the best of the places around its point; the nearer ones first.
pub(super) fn beside(points: &[(Corner, Corner)], frame: Area, gap: i32, taken: &[Area]) -> Vec<Area> {
    let marks: Vec<Area> = points.iter().map(|&((x, y), _)| Area([x - gap, y - gap, x + gap, y + gap])).collect();
    let mut taken = taken.to_vec();
    let mut placed = Vec::new();
    for &((x, y), (width, height)) in points {
        let (half_width, half_height) = (width / 2, height / 2);
        let mut places = Vec::new();
        for distance in [gap + gap / 2, 3 * gap, 5 * gap] {
            let (side, stack) = (distance + half_width, distance + half_height);
            let diagonal = gap + half_width;
            places.extend([(side, 0), (-side, 0), (0, -stack), (0, stack)]);
            places.extend([(diagonal, -stack), (diagonal, stack), (-diagonal, -stack), (-diagonal, stack)]);
        }
        let area = |(dx, dy): (i32, i32)| {
            let (x, y) = (x + dx, y + dy);
            Area([x - half_width, y - half_height, x + half_width, y + half_height])
        };
        let cost = |(rank, place): &(usize, Area)| {
            let covered = |others: &[Area]| others.iter().map(|other| place.common(*other)).sum::<i32>();
            // A little of a name is covered rather than a name put far off, but hardly any of a mark.
            covered(&taken)
                + 8 * covered(&marks)
                + 2 * (place.size() - place.common(frame))
                + *rank as i32 * place.size() / 100
        };
        let best =
            places.into_iter().map(area).enumerate().min_by_key(cost).map_or(Area([x, y, x, y]), |(_, area)| area);
        taken.push(best);
        placed.push(best);
    }
    placed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_hardly_cover_each_other_and_no_middle_of_a_mark() {
        let frame = Area([0, 0, 1000, 1000]);
        let points = [(500, 500), (520, 510), (480, 520), (900, 500), (20, 20)].map(|point| (point, (200, 30)));
        let placed = beside(&points, frame, 10, &[]);
        for (i, a) in placed.iter().enumerate() {
            assert_eq!(a.common(frame), a.size(), "{a:?}");
            assert!(placed[..i].iter().all(|b| a.common(*b) < a.size() / 8), "{placed:?}");
            assert!(points.iter().all(|&((x, y), _)| a.common(Area([x, y, x + 1, y + 1])) == 0));
        }
    }
}
