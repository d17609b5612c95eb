//! Messages and their numbers.

use leadscrew::protocol::Described;
use leadscrew::protocol::frame::Channel;
use leadscrew::protocol::reply::Reply;
use leadscrew::protocol::request::Request;
use serde::{Deserialize, Serialize};

/// A message of each number: of any fields, read from a body that is all zeros but its number.
fn each<'b, M: Deserialize<'b> + Serialize>(all: &[Described], bodies: &'b [Vec<u8>]) -> Vec<M> {
    let made = bodies
        .iter()
        .map(|body| postcard::take_from_bytes(body).unwrap().0);
    let made: Vec<M> = made.collect();
    for (message, described) in made.iter().zip(all) {
        let bytes = postcard::to_stdvec(message).unwrap();
        assert_eq!(bytes[0], described.number, "{}", described.name);
    }
    made
}

fn bodies(count: usize) -> Vec<Vec<u8>> {
    let body = |number| {
        let mut body = vec![0; 400];
        body[0] = number as u8;
        body
    };
    (0..count).map(body).collect()
}

#[test]
fn every_message_is_read_by_its_number_and_described() {
    let of_requests = bodies(Request::ALL.len());
    let requests: Vec<Request<'_>> = each(Request::ALL, &of_requests);
    for (request, described) in requests.iter().zip(Request::ALL) {
        assert_eq!(
            (request.number(), request.name()),
            (described.number, described.name)
        );
        assert!(
            !(request.needs_lease() && request.is_query()),
            "{request:?}"
        );
    }
    let of_replies = bodies(Reply::ALL.len());
    let replies: Vec<Reply<'_>> = each(Reply::ALL, &of_replies);
    for (reply, described) in replies.iter().zip(Reply::ALL) {
        assert_eq!(
            (reply.number(), reply.name()),
            (described.number, described.name)
        );
    }
    for described in Request::ALL.iter().chain(Reply::ALL) {
        let texts = described.fields.iter().map(|field| field.what);
        for text in texts.chain([*described.what.last().unwrap()]) {
            assert!(text.ends_with('.'), "{}: {text}", described.name);
        }
    }
    for (number, all) in [(60, Request::ALL.len()), (19, Reply::ALL.len())] {
        assert_eq!(all, number, "a new one is appended: count it here");
    }
}

#[test]
fn channels_lead_back_to_their_numbers() {
    for channel in Channel::ALL {
        assert_eq!(Channel::from_number(*channel as u8), Some(*channel));
    }
    assert_eq!(
        (Channel::from_number(0), Channel::from_number(5)),
        (None, None)
    );
}
